# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the starts and stops of the four nodes (starts.py)."""

import collections

from mrp_bench import cold, stats

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
    "megabytes_read": lambda one: None if one["in_container"] else one["read"],
}


def _columns(starts):
    """Return (variant's name, whether cold) -> its starts, in the order of the table."""
    columns = collections.defaultdict(list)
    for one in starts:
        columns[one["variant"], one["cold"]].append(one)
    # Ours is the first, then the others; each warm, then cold.
    return dict(sorted(columns.items(), key=lambda item: (item[0][0] != "mrp", item[0])))


def summarise(starts, missing):
    """Return what results.json says of starts. missing: of starts.load()."""
    columns = [_column(name, is_cold, of) for (name, is_cold), of in _columns(starts).items()]
    ours = [one for one in starts if one["variant"] == "mrp" and not one["cold"]]
    return {
        "columns": columns,
        "missing": missing,
        "timeline": _timeline(ours) if ours else None,
    }


def _column(name, is_cold, starts):
    """Return a column of the table. why_not: why it has no figures, or None."""
    return {
        "variant": name,
        "cold": is_cold,
        "why_not": cold.why_not(starts) if is_cold else None,
        "figures": {what: _estimate(map(value, starts)) for what, value in _FIGURES.items()},
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
    """Return (node, code, how often) of each that was not 0; None if no exit code was seen."""
    if not any(one["exits"] for one in starts):
        return None
    counts = collections.Counter(
        (name.rsplit("/", 1)[-1], code)
        for one in starts
        for name, code in one["exits"].items()
        if code
    )
    return [(name, code, count) for (name, code), count in counts.items()]


def _timeline(starts):
    """Return what happened in the most usual of these starts. Times are in seconds."""
    start = sorted(starts, key=lambda one: max(_all(one, "received")))[len(starts) // 2]
    received = {
        who.lower().replace(" ", "_"): _received(start, who)
        for who in (_CPP, _PY)
        if _received(start, who)
    }
    return {
        "stop": start["stop"],
        "end": start["end"],
        "bars": {name.rsplit("/", 1)[-1]: spans for name, spans in _bars(start).items()},
        "first_message": received,
    }


def _bars(start):
    """Return process -> when it starts, runs, gets the signal to end, and has ended."""
    of = collections.defaultdict(dict)
    for moment, what, name in start["events"]:
        of[name][what] = moment
    of["master"]["ready"] = of[""]["master"]
    names = [name for name in of if "started" in of[name] and "ready" in of[name]]
    launching = max(of[name]["started"] for name in names)
    bars = {"roslaunch": (0, launching, start["stop"], start["end"])}
    for name in names:
        signalled = of[name].get("stopping", start["stop"])
        ended = start["ended"].get(name, start["end"])
        bars[name] = (of[name]["started"], of[name]["ready"], signalled, ended)
    return bars
