# SPDX-License-Identifier: BSD-3-Clause
"""The tables of what results.json says, for table.md and for the tutorial's pages.

It imports no library, because the pages are built without numpy and without ROS.
"""

from typing import NamedTuple

from mrp_bench.ways import LIMITS, WAYS, size_text

NOISY = "too noisy"

# A ratio is no figure if the bounds of its confidence interval lie further apart than this factor.
_WIDEST_INTERVAL = 2


class Table(NamedTuple):
    """rows, header: lists of texts. before: the paragraphs above it."""

    title: str
    header: list
    rows: list
    before: tuple = ()


def machine(content):
    """Return the paragraphs that say where and how the figures were measured."""
    facts, noise = content["machine"], content["noise"]
    verdict = content["verdict"]
    return [
        f"Measured on {facts['cores']} cores of {facts['processor']}, {facts['gigabytes']} GB, "
        f"{facts['system']}, Linux {facts['kernel']}, roscpp {facts['roscpp']}, "
        f"Python {facts['python']}.",
        f"Noise: other programs took {_percent(noise['least'])} to {_percent(noise['most'])} of "
        f"the processors' time, in {noise['probes']} probes.",
        *([f"**{verdict[0].upper()}{verdict[1:]}.** The samples are kept."] if verdict else []),
    ]


def summary(content):
    """Return the table of the plain nodes beside the limit: messages of 8 bytes."""
    by_way = {
        rate: {
            row["way"]: row for row in content["rows"] if (row["size"], row["rate"]) == (8, rate)
        }
        for rate in (1000, 0)
    }
    rows = []
    for way in ("raw_cpp", "cpp_cpp", "cpp_py", "py_cpp", "py_py"):
        slow, fast = by_way[1000][way], by_way[0][way]
        ratio = slow["latency_ratio"].get("raw_cpp")
        rows.append(
            [
                WAYS[way].text,
                f"{slow['latency']['p50']:.0f}",
                f"{slow['latency']['p99']:.0f}",
                f"{ratio[0]:.1f}" if ratio else "1",
                _thousands(fast["throughput"]),
            ]
        )
    header = ["way", "p50, µs", "p99, µs", "x raw TCP", "messages per second"]
    return [Table("Messages of 8 bytes", header, rows)]


def latency(content):
    """Return a table for each size and rate."""
    header = ["way", "p50, µs", "p90, µs", "p99, µs", "max, µs", "x C++", "x Python"]
    header += ["lost", "order", "CPU: sender", "receiver"]
    noisy = content["verdict"]
    return [
        Table(
            f"{size_text(size)} at {rate} Hz",
            header,
            [
                [
                    WAYS[row["way"]].text,
                    *(NOISY if noisy else f"{value:.1f}" for value in row["latency"].values()),
                    *(_ratio(row["latency_ratio"].get(limit), noisy) for limit in LIMITS),
                    *_delivered(row, noisy),
                ]
                for row in rows
            ],
        )
        for size, rate, rows in _slices(content)
        if rate
    ]


def throughput(content):
    """Return a table for each size."""
    header = ["way", "per second", "x C++", "x Python", "lost", "order"]
    header += ["CPU: sender", "receiver"]
    noisy = content["verdict"]
    return [
        Table(
            f"{size_text(size)} as fast as it goes",
            header,
            [
                [
                    WAYS[row["way"]].text,
                    NOISY if noisy else _thousands(row["throughput"]),
                    *(_ratio(row["throughput_ratio"].get(limit), noisy) for limit in LIMITS),
                    *_delivered(row, noisy),
                ]
                for row in rows
            ],
        )
        for size, rate, rows in _slices(content)
        if not rate
    ]


def _slices(content):
    for size, rate in sorted({(row["size"], row["rate"]) for row in content["rows"]}):
        rows = [row for row in content["rows"] if (row["size"], row["rate"]) == (size, rate)]
        yield size, rate, rows


def _delivered(row, noisy):
    """Return the last cells: what was lost does not depend on noise, but processor time does."""
    lost = f"{row['lost']} of {row['sent']}" if row["lost"] else "0"
    order = f"{row['disordered']} wrong" if row["disordered"] else "kept"
    sender, receiver = row["sender_cpu"], row["receiver_cpu"]
    cpu = [f"{sender:.2f}", "the same" if receiver is None else f"{receiver:.2f}"]
    return [lost, order, *([NOISY, NOISY] if noisy else cpu)]


def _ratio(estimate, noisy):
    if estimate is None:
        return ""
    return NOISY if noisy or is_noisy(estimate) else _interval(estimate)


def is_noisy(estimate):
    """Return whether a value with its bounds is too uncertain to be a figure."""
    _, low, high = estimate
    return high > _WIDEST_INTERVAL * low


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
    of, noisy = content["robots"], content["verdict"]
    if not of["figures"]:
        return []
    rows = [
        [str(figure["robots"]), *_costs(figure, ROBOTS, noisy), str(figure["lost"])]
        for figure in of["figures"]
    ]
    return [
        Table(
            "Many robots of four nodes each",
            ["robots", *ROBOTS.values(), "lost"],
            rows,
            ["The latencies are those of 8 bytes at 100 Hz, from C++ to C++, beside the robots."],
        )
    ]


def _costs(figure, names, noisy):
    return [
        NOISY if noisy else f"{figure[name]:.0f}" if name in _WHOLE else f"{figure[name]:.2f}"
        for name in names
    ]


def _interval(estimate):
    """Return a value and its bounds; of a single measurement there are no bounds."""
    value, *bounds = (f"{number:.2f}" for number in estimate)
    return f"{value} [{', '.join(bounds)}]" if bounds else value


def _thousands(value):
    return f"{value:,.0f}".replace(",", " ")


def _percent(share):
    return f"{share:.1%}".replace("%", " %")


# Their names, as the pages call them.
TABLES = {
    "summary": summary,
    "latency": latency,
    "throughput": throughput,
    "robots": robots,
}
