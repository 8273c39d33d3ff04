# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the starts of many robots (launches.py)."""

import collections
import statistics

from mrp_bench import stats

# What is fitted: a name, and how it follows from what was measured.
_FIGURES = {
    "up": lambda one: one["up"],
    "down": lambda one: one["end"] - one["stop"],
    "cores": lambda one: one["cores"],
    "cpp": lambda one: one["cpp_megabytes"],
    "py": lambda one: one["py_megabytes"],
    "p50": lambda one: _latency(one, "p50"),
    "p99": lambda one: _latency(one, "p99"),
}


def _delivery(one):
    return stats.delivery(one["pair"]["sent"], one["pair"]["received"])


def _latency(one, percentile):
    return stats.percentiles(_delivery(one).latencies)[percentile] / 1e3


def medians(launches):
    """Return the number of robots -> a figure's name -> its median over the rounds."""
    grouped = collections.defaultdict(list)
    for launch in launches:
        grouped[launch["robots"]].append(launch)
    return {
        robots: {
            name: statistics.median(value(one) for one in ones) for name, value in _FIGURES.items()
        }
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
        for name in _FIGURES
    }


def most(figures, cores, megabytes):
    """Return how many robots of four nodes fill so many cores, and how many so many megabytes.

    It goes on from the largest number that was measured, with the exponent of exponents() for the
    cores, and the same memory for each node.
    """
    largest, of = max(figures.items())
    by_cores = largest * (cores / of["cores"]) ** (1 / exponents(figures)["cores"].value)
    return round(by_cores), round(megabytes / (2 * of["cpp"] + 2 * of["py"]))


def summarise(launches, cores, megabytes):
    """Return what results.json says of many robots. cores, megabytes: of this machine.

    most: of most(), or None if there are too few numbers of robots
    """
    figures = medians(launches)
    lost = collections.Counter()
    for launch in launches:
        lost[launch["robots"]] += _delivery(launch).lost
    return {
        "figures": [
            {"robots": robots, **of, "lost": lost[robots]} for robots, of in figures.items()
        ],
        "exponents": exponents(figures),
        "most": most(figures, cores, megabytes) if len(figures) > 2 else None,
    }
