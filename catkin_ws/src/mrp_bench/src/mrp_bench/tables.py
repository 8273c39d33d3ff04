# SPDX-License-Identifier: BSD-3-Clause
"""The tables of what results.json says, for a terminal and for the tutorial's pages.

It imports no library, because the pages are built without numpy and without ROS.
"""

from typing import NamedTuple

from mrp_bench.ways import WAYS, size_text


class Table(NamedTuple):
    """rows, header: lists of texts. before: the paragraphs above it."""

    title: str
    header: list
    rows: list
    before: tuple = ()


def machine(content):
    """Return the paragraph that says where the figures were measured."""
    facts = content["machine"]
    return (
        f"Measured on {facts['cores']} cores of {facts['processor']}, {facts['gigabytes']} GB, "
        f"{facts['system']}, Linux {facts['kernel']}, roscpp {facts['roscpp']}, "
        f"Python {facts['python']}."
    )


def summary(content):
    """Return the table of the plain nodes beside the limit: messages of 8 bytes."""
    by_way = {
        rate: {
            row["way"]: row for row in content["rows"] if (row["size"], row["rate"]) == (8, rate)
        }
        for rate in (1000, 0)
    }
    rows = []
    for way in ("raw", "cpp_cpp", "cpp_py", "py_cpp", "py_py"):
        slow, fast = by_way[1000][way], by_way[0][way]
        rows.append(
            [
                WAYS[way].text,
                f"{slow['latency']['p50']:.0f}",
                f"{slow['latency']['p99']:.0f}",
                f"{slow['latency_ratio']:.1f}",
                _thousands(fast["throughput"]),
            ]
        )
    header = ["way", "p50, µs", "p99, µs", "x raw TCP", "messages per second"]
    return [Table("Messages of 8 bytes", header, rows)]


def latency(content):
    """Return a table for each size and rate."""
    header = ["way", "p50, µs", "p90, µs", "p99, µs", "max, µs", "x"]
    return [
        _table(
            f"{size_text(size)} at {rate} Hz",
            header,
            rows,
            lambda row: [
                *(f"{value:.1f}" for value in row["latency"].values()),
                f"{row['latency_ratio']:.2f}",
            ],
        )
        for size, rate, rows in _slices(content)
        if rate
    ]


def throughput(content):
    """Return a table for each size."""
    header = ["way", "per second", "x"]
    return [
        _table(
            f"{size_text(size)} as fast as it goes",
            header,
            rows,
            lambda row: [_thousands(row["throughput"]), f"{row['throughput_ratio']:.2f}"],
        )
        for size, rate, rows in _slices(content)
        if not rate
    ]


def _table(title, header, rows, cells):
    """Return a Table of ways: a way's text, its own cells, and what all have in common."""
    header = [*header, "lost", "order", "CPU: sender", "receiver"]
    all_cells = [[WAYS[row["way"]].text, *cells(row), *_delivered(row)] for row in rows]
    return Table(title, header, all_cells)


def _slices(content):
    for size, rate in sorted({(row["size"], row["rate"]) for row in content["rows"]}):
        rows = [row for row in content["rows"] if (row["size"], row["rate"]) == (size, rate)]
        yield size, rate, rows


def _delivered(row):
    lost = f"{row['lost']} of {row['sent']}" if row["lost"] else "0"
    order = f"{row['disordered']} wrong" if row["disordered"] else "kept"
    receiver = row["receiver_cpu"]
    receiver = "the same" if receiver is None else f"{receiver:.2f}"
    return [lost, order, f"{row['sender_cpu']:.2f}", receiver]


# What is tabled of many robots.
ROBOTS = {
    "up": "all nodes ready, s",
    "down": "Ctrl-C to the end, s",
    "cores": "cores in use",
    "cpp": "MB per C++ node",
    "py": "MB per Python node",
    "p50": "p50 beside them, µs",
    "p99": "p99, µs",
}
_WHOLE = ("p50", "p99")  # without decimals


def robots(content):
    """Return the table of many robots, if there were any."""
    rows = [
        [
            str(figure["robots"]),
            *(f"{figure[name]:.{0 if name in _WHOLE else 2}f}" for name in ROBOTS),
            str(figure["lost"]),
        ]
        for figure in content["robots"]
    ]
    header = ["robots", *ROBOTS.values(), "lost"]
    beside = "The latencies are those of 8 bytes at 100 Hz, from C++ to C++, beside the robots."
    return [Table("Many robots of four nodes each", header, rows, [beside])] if rows else []


def _thousands(value):
    return f"{value:,.0f}".replace(",", " ")


# Their names, as the pages call them.
TABLES = {
    "summary": summary,
    "latency": latency,
    "throughput": throughput,
    "robots": robots,
}


def markdown(content):
    """Return all of it as text."""
    parts = [machine(content)]
    for name in ("latency", "throughput", "robots"):
        for table in TABLES[name](content):
            lines = [table.header, ["---"] + ["---:"] * (len(table.header) - 1), *table.rows]
            text = "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
            parts += [f"### {table.title}", *table.before, text]
    return "\n\n".join(parts)
