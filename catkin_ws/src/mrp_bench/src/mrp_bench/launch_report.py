# SPDX-License-Identifier: BSD-3-Clause
"""The report on many robots (launches.py): a table, and a plot."""

import collections
import statistics

from mrp_bench import stats

# What is tabled and fitted: a name, its text, and how it follows from what was measured.
_FIGURES = [
    ("up", "all nodes ready, s", lambda one: one["up"]),
    ("down", "Ctrl-C to the end, s", lambda one: one["end"] - one["stop"]),
    ("cores", "cores in use", lambda one: one["cores"]),
    ("cpp", "MB per C++ node", lambda one: one["cpp_megabytes"]),
    ("py", "MB per Python node", lambda one: one["py_megabytes"]),
]


def medians(launches):
    """Return the number of robots -> a figure's name -> its median over the rounds."""
    grouped = collections.defaultdict(list)
    for one in launches:
        grouped[one["robots"]].append(one)
    return {
        robots: {name: statistics.median(value(one) for one in ones) for name, _, value in _FIGURES}
        for robots, ones in sorted(grouped.items())
    }


def exponents(figures):
    """Return a figure's name -> stats.Estimate of how it grows with the robots; see medians().

    Empty if there are fewer than three numbers of robots.
    """
    if len(figures) < 3:
        return {}
    return {
        name: stats.exponent(list(figures), [of[name] for of in figures.values()])
        for name, _, _ in _FIGURES
    }


def markdown(launches, noisy):
    """Return the table's lines. noisy: what stands instead of a figure, or None."""
    figures = medians(launches)
    if not figures:
        return []
    lines = [
        "### Many robots of four nodes each",
        "",
        "| robots | " + " | ".join(text for _, text, _ in _FIGURES) + " |",
        "| ---: " * (1 + len(_FIGURES)) + "|",
    ]
    for robots, of in figures.items():
        cells = [noisy or f"{of[name]:.2f}" for name, _, _ in _FIGURES]
        lines.append(f"| {robots} | " + " | ".join(cells) + " |")
    found = exponents(figures)
    if found:
        cells = [noisy or "{:.2f} [{:.2f}, {:.2f}]".format(*found[name]) for name, _, _ in _FIGURES]
        lines.append("| exponent | " + " | ".join(cells) + " |")
    return [*lines, ""]


def scale(launches, axes):
    """Draw how the figures grow with the number of robots."""
    figures = medians(launches)
    found = exponents(figures)
    marks = zip(_FIGURES, ("#0072b2", "#56b4e9", "#d55e00", "#000000", "#777777"), "ovXsD")
    for (name, text, _), color, mark in marks:
        label = f"{text}: exponent {found[name].value:.2f}"
        values = [of[name] for of in figures.values()]
        axes.plot(list(figures), values, color=color, marker=mark, label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(list(figures))
    axes.set_xticklabels(list(figures))
    axes.set_xticks([], minor=True)
    axes.set_xlabel("robots of four nodes each")
    axes.grid(which="both", color="#dddddd")
    axes.set_title("How start, stop, processor time and memory grow", loc="left")
    axes.legend()
