# SPDX-License-Identifier: BSD-3-Clause
"""The report on the start and stop of the four nodes (starts.py): a table, and a timeline."""

import collections
import signal

from mrp_bench import cold, stats

# What roslaunch starts besides, of its own.
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


# A row's text, and how it follows from a start; None: that did not happen, or cannot be seen.
_ROWS = [
    ("roslaunch's first line", lambda one: min(_all(one, "first line"))),
    ("the master answers", lambda one: min(_all(one, "master"), default=None)),
    ("the first node is started", lambda one: min(_all(one, "started"))),
    ("all four are started", lambda one: max(_all(one, "started"))),
    ("all four are ready", lambda one: max(_all(one, "ready"))),
    ("first message at the C++ subscriber", lambda one: _received(one, _CPP)),
    ("first message at the Python subscriber", lambda one: _received(one, _PY)),
    ("Ctrl-C to the end of all four", _nodes_ended),
    ("Ctrl-C to the prompt", lambda one: one["end"] - one["stop"]),
    ("read from the disk, MB", lambda one: None if one["in_container"] else one["read"]),
]


def _columns(starts):
    """Return (variant's name, whether cold) -> its starts, in the order of the table."""
    columns = collections.defaultdict(list)
    for one in starts:
        columns[one["variant"], one["cold"]].append(one)
    # Ours is the first, then the others; each warm, then cold.
    return dict(sorted(columns.items(), key=lambda item: (item[0][0] != "mrp", item[0])))


def markdown(starts, missing, noisy):
    """Return the table's lines. noisy: what stands instead of a figure, or None."""
    columns = _columns(starts)
    if not columns:
        return []
    why = {f"{name}, cold": cold.why_not(of) for (name, is_cold), of in columns.items() if is_cold}
    why = {**{name: text for name, text in why.items() if text}, **missing}
    titles = {
        f"{name}, {'cold' if is_cold else 'warm'}": of for (name, is_cold), of in columns.items()
    }
    lines = [
        "### Start and stop of the four nodes",
        "",
        "In seconds from the call, and from Ctrl-C: the medians of the rounds, and in brackets "
        "their confidence intervals of 95 %.",
        "",
        "| until | " + " | ".join(titles) + " |",
        "| --- " + "| ---: " * len(titles) + "|",
    ]
    for text, value in _ROWS:
        cells = []
        for title, of in titles.items():
            cells.append("not measured" if title in why else noisy or _cell(map(value, of)))
        lines.append(f"| {text} | " + " | ".join(cells) + " |")
    lines.append("| exit codes | " + " | ".join(map(_exits, titles.values())) + " |")
    lines += ["", *(f"{name}: {text}.\n" for name, text in why.items())]
    return lines


def _cell(values):
    values = list(values)
    if None in values:
        return "not seen"
    estimate = stats.median(values)
    if len(values) == 1:
        return f"{estimate.value:.2f}"
    return "{:.2f} [{:.2f}, {:.2f}]".format(*estimate)


def _exits(starts):
    """Return how nodes ended otherwise than with 0, and in how many of the starts."""
    if not any(one["exits"] for one in starts):
        return "not seen"
    counts = collections.Counter(
        (name.rsplit("/", 1)[-1], code)
        for one in starts
        for name, code in one["exits"].items()
        if code
    )
    return (
        ", ".join(
            f"{name}: {signal.Signals(-code).name if code < 0 else code} ({count} of {len(starts)})"
            for (name, code), count in counts.items()
        )
        or "all 0"
    )


# What the bars say, and their colours (Okabe and Ito's).
_COLORS = {"starts": "#e69f00", "runs": "#0072b2", "has been told to end": "#d55e00"}


def timeline(starts, figure):
    """Draw the most usual of these starts: when each process starts, runs, and ends."""
    start = sorted(starts, key=lambda one: max(_all(one, "received")))[len(starts) // 2]
    bars = _bars(start)
    # A second is as wide in both.
    widths = [start["stop"], start["end"] - start["stop"] + 0.2]
    left, right = figure.subplots(1, 2, sharey=True, gridspec_kw={"width_ratios": widths})
    for y, spans in enumerate(bars.values()):
        for axes, zero in ((left, 0), (right, start["stop"])):
            for (what, color), begin, end in zip(_COLORS.items(), spans, spans[1:]):
                label = what if y == 0 and axes is left else None
                axes.barh(y, end - begin, left=begin - zero, color=color, label=label)
    for y, name in enumerate(bars):
        for who in (_CPP, _PY):
            if name.endswith(who.lower().replace(" ", "_")) and _received(start, who):
                label = "has its first message" if who == _PY else None
                left.plot(_received(start, who), y, "k^", markersize=9, clip_on=False, label=label)
    left.set_yticks(range(len(bars)))
    left.set_yticklabels([name.rsplit("/", 1)[-1] for name in bars])
    left.invert_yaxis()
    left.set_xlim(0, start["stop"])
    left.set_xlabel("seconds since roslaunch was called")
    right.set_xlim(-0.2, start["end"] - start["stop"])
    right.axvline(0, color="#000000", linewidth=1)
    right.set_xlabel("seconds since Ctrl-C")
    left.set_title("Start and stop of the four nodes", loc="left")
    figure.legend(*left.get_legend_handles_labels(), loc="lower center", ncol=4)
    figure.subplots_adjust(left=0.2, right=0.98, bottom=0.24, top=0.92, wspace=0.04)


def _bars(start):
    """Return process -> when it starts, runs, is told to end, and has ended."""
    of = collections.defaultdict(dict)
    for moment, what, name in start["events"]:
        of[name][what] = moment
    of["master"]["ready"] = of[""]["master"]
    names = [name for name in of if "started" in of[name] and "ready" in of[name]]
    launching = max(of[name]["started"] for name in names)
    bars = {"roslaunch": (0, launching, start["stop"], start["end"])}
    for name in names:
        told = of[name].get("stopping", start["stop"])
        ended = start["ended"].get(name, start["end"])
        bars[name] = (of[name]["started"], of[name]["ready"], told, ended)
    return bars
