# SPDX-License-Identifier: BSD-3-Clause
"""The report on fans (fans.py): a table for each language and direction, and a plot."""

import collections

import matplotlib.ticker

from mrp_bench import stats
from mrp_bench.fans import LANGUAGES, PIECE

# What is tabled and fitted: a name, and its text.
_FIGURES = {
    "up": "all connected, s",
    "cores": "cores in use",
    "publisher_megabytes": "MB per publisher",
    "subscriber_megabytes": "MB per subscriber",
    "p50": "p50, us",
    "p99": "p99, us",
    "per_second": "messages per second",
}

# In the order of the tables; one to one is in both.
_DIRECTIONS = {
    "publishers": "publishers to one subscriber",
    "subscribers": "subscribers of one publisher",
}

# The share of the messages that are sent first and are left out of the latencies: until then the
# nodes have been woken up.
_WARM_UP = 0.1

# The share of the processors' time above which they count as full: the nodes do not get all of it.
_FULL = 0.9


def figures(fan):
    """Return a dictionary of all in _FIGURES, of "sent" and of "lost"; fan: of fans.measure()."""
    sent = sorted(fan["sent"])
    warm = sent[int(len(sent) * _WARM_UP)]
    latencies = []
    lost = 0
    for received in fan["received"]:
        pairs = list(zip(received[::2], received[1::2]))
        # A stamp may be there twice: of two publishers at the same nanosecond.
        missing = collections.Counter(sent) - collections.Counter(received[::2])
        lost += sum(missing.values())
        latencies += [(arrival - stamp) / 1e3 for stamp, arrival in pairs if stamp >= warm]
    arrived = len(sent) * len(fan["received"]) - lost
    seconds = (max(max(received[1::2]) for received in fan["received"] if received) - sent[0]) / 1e9
    percentiles = stats.percentiles(latencies)
    return {
        **{name: fan[name] for name in ("up", "publisher_megabytes", "subscriber_megabytes")},
        "cores": (fan["sender_cpu"] + fan["receiver_cpu"]) / seconds,
        "p50": percentiles["p50"],
        "p99": percentiles["p99"],
        "per_second": arrived / seconds,
        "sent": arrived + lost,
        "lost": lost,
    }


def series(fans):
    """Return pairs of a language and a direction -> how many nodes -> figures()."""
    found = {(language, side): {} for side in _DIRECTIONS for language in LANGUAGES}
    for fan in fans:
        for side, other in (("publishers", "subscribers"), ("subscribers", "publishers")):
            if fan[other] == 1:
                found[fan["language"], side][fan[side]] = figures(fan)
    return {key: of for key, of in found.items() if of}


def rows(fans):
    """Return a list of dictionaries: of each fan the nodes, and figures()."""
    names = ("language", "publishers", "subscribers")
    return [{**{name: fan[name] for name in names}, **figures(fan)} for fan in fans]


def exponents(of):
    """Return a figure's name -> stats.Estimate of its growth; of: how many nodes -> figures().

    Empty if there are fewer than three numbers of nodes.
    """
    if len(of) < 3:
        return {}
    return {name: stats.exponent(list(of), [one[name] for one in of.values()]) for name in _FIGURES}


def full_at(of, cores):
    """Return the smallest number of nodes that fill so many cores, or None."""
    return next((count for count, one in of.items() if one["cores"] > _FULL * cores), None)


def markdown(fans, cores, noisy):
    """Return the tables' lines. cores: of this machine. noisy: stands for a figure, or is None."""
    if not fans:
        return []
    lines = [
        f"In the tables below each publisher sends {PIECE.size} bytes at {PIECE.rate} Hz, and all "
        "begin at once. Cores in use are those of all the nodes together, while they do. A cost "
        "grows with the number of nodes to the power of its exponent.",
        "",
    ]
    for (language, side), of in series(fans).items():
        lines += [
            f"### {LANGUAGES[language][0]}: {_DIRECTIONS[side]}",
            "",
            f"| {side} | " + " | ".join([*_FIGURES.values(), "lost"]) + " |",
            "| ---: " * (2 + len(_FIGURES)) + "|",
        ]
        for count, one in of.items():
            cells = [noisy or f"{one[name]:.{_digits(name)}f}" for name in _FIGURES]
            lost = f"{one['lost']} of {one['sent']}" if one["lost"] else "0"
            lines.append(f"| {count} | " + " | ".join([*cells, lost]) + " |")
        found = exponents(of)
        if found:
            cells = [noisy or "{:.2f} [{:.2f}, {:.2f}]".format(*found[name]) for name in _FIGURES]
            lines.append("| exponent | " + " | ".join([*cells, ""]) + " |")
        lines.append("")
        if not noisy:
            full = full_at(of, cores)
            says = f"{full} {side} fill" if full else f"{max(of)} {side} do not fill"
            lines += [f"{says} the {cores} cores.", ""]
    return lines


def _digits(name):
    return 0 if name in ("p50", "p99", "per_second") else 2


# A colour for each language, a mark and a line for each direction.
_COLORS = {"cpp": "#0072b2", "py": "#d55e00"}
_STYLES = {"publishers": ("o", "-"), "subscribers": ("^", "--")}

_PLAIN = matplotlib.ticker.StrMethodFormatter("{x:g}")


def draw(fans, cores, figure):
    """Draw how the figures grow with the number of nodes. cores: of this machine."""
    found = series(fans)
    counts = sorted({count for of in found.values() for count in of})
    panels = {
        "Seconds from start until all are connected": ["up"],
        f"Cores in use, of {cores}": ["cores"],
        "MB per node of the many": ["many_megabytes"],
        "Latency in microseconds: p50, and thin p99": ["p50", "p99"],
    }
    grid = figure.subplots(2, 2, sharex=True)
    for axes, (title, names) in zip(grid.flat, panels.items()):
        for (language, side), of in found.items():
            mark, line = _STYLES[side]
            for name in names:
                if name == "many_megabytes":
                    name = side[:-1] + "_megabytes"
                axes.plot(
                    list(of),
                    [one[name] for one in of.values()],
                    color=_COLORS[language],
                    marker=mark,
                    linestyle=line,
                    linewidth=0.7 if name == "p99" else 1.5,
                    label=f"{LANGUAGES[language][0]}: {_DIRECTIONS[side]}",
                )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(_PLAIN)
        axes.set_title(title, loc="left")
        axes.grid(which="both", color="#dddddd")
        if names == ["cores"]:
            axes.axhline(cores, color="#000000", linewidth=1)
        if names == ["up"]:
            axes.legend(fontsize=8, handlelength=4)
    for axes in grid[-1]:
        axes.set_xlabel("publishers or subscribers")
    # All have the same axis.
    axes.set_xticks(counts)
    axes.set_xticklabels(counts)
    axes.set_xticks([], minor=True)
