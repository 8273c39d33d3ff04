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
    ("p50", "p50 beside them, us", lambda one: _latency(one, "p50")),
    ("p99", "p99, us", lambda one: _latency(one, "p99")),
]

# What is drawn, with its colour and mark.
_LINES = {
    "up": ("#0072b2", "o"),
    "down": ("#56b4e9", "v"),
    "cores": ("#d55e00", "X"),
    "cpp": ("#000000", "s"),
    "py": ("#777777", "D"),
    "p50": ("#009e73", "^"),
}


def _delivery(one):
    return stats.delivery(one["pair"]["sent"], one["pair"]["received"])


def _latency(one, percentile):
    return stats.percentiles(_delivery(one).latencies)[percentile] / 1e3


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


def most(figures, cores, megabytes):
    """Return how many robots of four nodes fill so many cores, and how many so many megabytes.

    It goes on from the largest number that was measured, with the exponent of exponents() for the
    cores, and the same memory for each node.
    """
    largest, of = max(figures.items())
    by_cores = largest * (cores / of["cores"]) ** (1 / exponents(figures)["cores"].value)
    return round(by_cores), round(megabytes / (2 * of["cpp"] + 2 * of["py"]))


def markdown(launches, cores, megabytes, noisy):
    """Return the table's lines. cores, megabytes: of this machine.

    noisy: what stands instead of a figure, or None
    """
    figures = medians(launches)
    if not figures:
        return []
    lines = [
        "### Many robots of four nodes each",
        "",
        "The latencies are those of 8 bytes at 100 Hz, from C++ to C++, beside the robots.",
        "",
        "| robots | " + " | ".join(text for _, text, _ in _FIGURES) + " | lost |",
        "| ---: " * (2 + len(_FIGURES)) + "|",
    ]
    for robots, of in figures.items():
        cells = [noisy or f"{of[name]:.{_digits(name)}f}" for name, _, _ in _FIGURES]
        lost = sum(_delivery(one).lost for one in launches if one["robots"] == robots)
        lines.append(f"| {robots} | " + " | ".join([*cells, str(lost)]) + " |")
    found = exponents(figures)
    if found:
        cells = [noisy or "{:.2f} [{:.2f}, {:.2f}]".format(*found[name]) for name, _, _ in _FIGURES]
        lines.append("| exponent | " + " | ".join([*cells, ""]) + " |")
    if found and not noisy:
        by_cores, by_memory = most(figures, cores, megabytes)
        lines += [
            "",
            f"If that goes on, {by_cores} robots fill the {cores} cores, and {by_memory} fill the "
            "memory.",
        ]
    return [*lines, ""]


def _digits(name):
    return 0 if name in ("p50", "p99") else 2


def scale(launches, axes):
    """Draw how the figures grow with the number of robots."""
    figures = medians(launches)
    found = exponents(figures)
    texts = {name: text for name, text, _ in _FIGURES}
    for name, (color, mark) in _LINES.items():
        label = f"{texts[name]}: exponent {found[name].value:.2f}"
        values = [of[name] for of in figures.values()]
        axes.plot(list(figures), values, color=color, marker=mark, label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(list(figures))
    axes.set_xticklabels(list(figures))
    axes.set_xticks([], minor=True)
    axes.set_xlabel("robots of four nodes each")
    axes.grid(which="both", color="#dddddd")
    axes.set_title("How start, stop, processor time, memory and latency grow", loc="left")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
