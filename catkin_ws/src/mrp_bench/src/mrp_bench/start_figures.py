# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the starts and stops of the four nodes (starts.py)."""

import collections

from mrp_bench import stats

# What roslaunch itself starts, too.
_OWN = ("master", "rosout")

_CPP, _PY = "SUBSCRIBER CPP NODE", "SUBSCRIBER PY NODE"


def _all(start, what):
    return [moment for moment, of, name in start["events"] if of == what and name not in _OWN]


def _received(start, who):
    found = [moment for moment, what, name in start["events"] if (what, name) == ("received", who)]
    return found[0] if found else None


def _nodes_ended(start):
    ended = [moment for name, moment in start["ended"].items() if name not in _OWN]
    return max(ended) - start["stop"] if ended else None


# How a figure follows from a start; None: that did not happen, or cannot be seen.
_FIGURES = {
    "first_line": lambda one: min(_all(one, "first line")),
    "master": lambda one: min(_all(one, "master"), default=None),
    "first_started": lambda one: min(_all(one, "started")),
    "all_started": lambda one: max(_all(one, "started")),
    "all_ready": lambda one: max(_all(one, "ready")),
    "received_cpp": lambda one: _received(one, _CPP),
    "received_py": lambda one: _received(one, _PY),
    "nodes_ended": _nodes_ended,
    "ended": lambda one: one["end"] - one["stop"],
}


def summarise(starts):
    """Return what results.json says of starts; figures is empty if there were none."""
    return {
        "figures": {what: _estimate(map(value, starts)) for what, value in _FIGURES.items()}
        if starts
        else {},
        "exits": _exits(starts),
        "starts": len(starts),
    }


def _estimate(values):
    """Return the median and the bounds of its interval; of one value no bounds; or None."""
    values = list(values)
    if None in values:
        return None
    return values if len(values) == 1 else stats.median(values)


def _exits(starts):
    """Return (node, code, how often) of each exit code that was not 0."""
    counts = collections.Counter(
        (name.rsplit("/", 1)[-1], code)
        for start in starts
        for name, code in start["exits"].items()
        if code
    )
    return [(name, code, count) for (name, code), count in counts.items()]
