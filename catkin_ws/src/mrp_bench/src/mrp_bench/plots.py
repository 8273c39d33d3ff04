# SPDX-License-Identifier: BSD-3-Clause
"""The plots of a report, each as SVG and as PNG."""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import matplotlib.ticker

from mrp_bench import fan_report, launch_report, start_report
from mrp_bench.rounds import size_text
from mrp_bench.ways import WAYS

# A colour for each of what is drawn as lines; they can be told apart by the colour-blind, too
# (Okabe and Ito's), and the marks tell them apart in print.
_LINES = {
    "raw_cpp": ("#000000", "s"),
    "raw_py": ("#777777", "D"),
    "cpp_cpp": ("#0072b2", "o"),
    "cpp_py": ("#56b4e9", "v"),
    "py_cpp": ("#e69f00", "^"),
    "py_py": ("#d55e00", "X"),
}
_COLOR, _LIMIT_COLOR = "#0072b2", "#777777"

_PLAIN = matplotlib.ticker.StrMethodFormatter("{x:g}")

plt.rcParams.update(
    {
        "svg.fonttype": "none",  # text stays text
        "svg.hashsalt": "mrp",  # the same figures give the same file
        "font.family": "sans-serif",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
    }
)


def draw(rows, starts, robots, fans, cores, verdict, folder):
    """Draw what the rows give, starts (starts.py), robots (launches.py), and fans (fans.py).

    cores: of this machine
    verdict: why they are not to be trusted, or None; it is written across
    """
    small = [row for row in rows if row.size == 8 and row.rate == 1000]
    if small:
        _save(_latencies(small), "latency", verdict, folder)
    lines = {
        "latency_by_size": _by(rows, "size", lambda row: row.rate),
        "latency_by_rate": _by(rows, "rate", lambda row: row.size == 8 and row.rate),
    }
    for name, figure in lines.items():
        if figure:
            _save(figure, name, verdict, folder)
    burst = [row for row in rows if row.size == 8 and row.rate == 0]
    if burst:
        _save(_throughputs(burst), "throughput", verdict, folder)
    ours = [one for one in starts if one["variant"] == "mrp" and not one["cold"]]
    if ours:
        figure = plt.figure(figsize=(9, 4))
        start_report.timeline(ours, figure)
        _save(figure, "start_and_stop", verdict, folder)
    if len({one["robots"] for one in robots}) > 2:
        figure, axes = plt.subplots(figsize=(9, 5), constrained_layout=True)
        launch_report.scale(robots, axes)
        _save(figure, "scale", verdict, folder)
    if len({one["publishers"] for one in fans}) > 2:
        figure = plt.figure(figsize=(9, 7), constrained_layout=True)
        fan_report.draw(fans, cores, figure)
        _save(figure, "fans", verdict, folder)


def _save(figure, name, verdict, folder):
    if verdict:
        figure.text(
            0.5,
            0.5,
            "too noisy a machine",
            ha="center",
            va="center",
            rotation=20,
            fontsize=34,
            color="#cc0000",
            alpha=0.35,
        )
    for ending in ("svg", "png"):
        metadata = {"Date": None} if ending == "svg" else {}
        figure.savefig(folder / f"{name}.{ending}", metadata=metadata, dpi=120)
    plt.close(figure)


def _dots_figure(rows, title, label):
    figure, axes = plt.subplots(figsize=(9, 1.2 + 0.3 * len(rows)), constrained_layout=True)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([WAYS[row.way].text for row in rows])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlabel(label)
    axes.set_title(title, loc="left")
    axes.grid(axis="x", which="both", color="#dddddd")
    return figure, axes


def _latencies(rows):
    rows = sorted(rows, key=lambda row: row.latency["p50"])
    figure, axes = _dots_figure(
        rows,
        "How long 8 bytes are on their way, at 1000 Hz",
        "microseconds: dot p50, thick line to p90, thin line to p99",
    )
    for y, row in enumerate(rows):
        color = _LIMIT_COLOR if WAYS[row.way].is_raw else _COLOR
        axes.hlines(y, row.latency["p50"], row.latency["p99"], color=color, linewidth=1)
        axes.hlines(y, row.latency["p50"], row.latency["p90"], color=color, linewidth=4)
        axes.plot(row.latency["p50"], y, "o", color=color)
        axes.annotate(
            f"{row.latency['p50']:.1f}",
            (row.latency["p50"], y),
            xytext=(-7, 0),
            textcoords="offset points",
            ha="right",
            va="center",
            fontsize=8,
        )
    axes.set_xlim(left=min(row.latency["p50"] for row in rows) / 1.7)
    axes.xaxis.set_major_formatter(_PLAIN)
    return figure


def _throughputs(rows):
    rows = sorted(rows, key=lambda row: -row.throughput)
    figure, axes = _dots_figure(
        rows, "Messages of 8 bytes, as fast as it goes", "messages per second"
    )
    for y, row in enumerate(rows):
        color = _LIMIT_COLOR if WAYS[row.way].is_raw else _COLOR
        axes.plot(row.throughput, y, "o", color=color)
        lost = f", {row.lost / row.sent:.0%} lost" if row.lost else ""
        axes.annotate(
            f"{row.throughput:,.0f}".replace(",", " ") + lost,
            (row.throughput, y),
            xytext=(7, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    axes.set_xlim(right=4 * max(row.throughput for row in rows))
    return figure


def _by(rows, attribute, wanted):
    """Return the figure of p50 against a size or a rate, or None if there is only one."""
    chosen = [row for row in rows if row.way in _LINES and wanted(row)]
    xs = sorted({getattr(row, attribute) for row in chosen})
    if len(xs) < 2:
        return None
    figure, axes = plt.subplots(figsize=(9, 5), constrained_layout=True)
    for way, (color, mark) in _LINES.items():
        points = {}
        for row in chosen:
            if row.way == way:
                # Of one size at several rates, the one that is nearest to 1000 Hz.
                points.setdefault(getattr(row, attribute), []).append(row)
        if not points:
            continue
        best = [min(points[x], key=lambda row: abs(row.rate - 1000)) for x in sorted(points)]
        axes.plot(
            sorted(points),
            [row.latency["p50"] for row in best],
            color=color,
            marker=mark,
            label=WAYS[way].text,
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    texts = [size_text(x) for x in xs] if attribute == "size" else [f"{x} Hz" for x in xs]
    axes.set_xticks(xs)
    axes.set_xticklabels(texts)
    axes.set_xticks([], minor=True)
    axes.yaxis.set_major_formatter(_PLAIN)
    axes.set_ylabel("p50, microseconds")
    axes.set_title(f"How long a message is on its way, by {attribute}", loc="left")
    axes.grid(which="both", color="#dddddd")
    axes.legend()
    return figure
