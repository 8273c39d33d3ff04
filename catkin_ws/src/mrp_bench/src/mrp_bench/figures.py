# SPDX-License-Identifier: BSD-3-Clause
"""Measure all ways in turns, and make the tables of the page on speed: lists of rows of texts."""

import collections
import csv
import os
import pathlib
import platform
import re
import statistics
import subprocess
import time

import numpy

from mrp_bench.running import measure
from mrp_bench.ways import LIMIT, PAIRS, PLAN, WAYS, size_text

_CPU = ["CPU: sender", "receiver"]
LATENCY = ["way", "size", "Hz", "p50, µs", "p99, µs", "max, µs", "x", *_CPU]
THROUGHPUT = ["way", "size", "per second", "x", *_CPU]
SUMMARY = ["way", "p50, µs", "p99, µs", "x raw TCP", "messages per second"]


def measure_all(rounds, log, say, plan=PLAN):
    """Measure a plan, all ways in turns, round after round.

    This way, whatever else the machine does meanwhile affects all ways alike.
    log: a file for what the programs print; say: called with a line after each measurement
    Returns (way, size, rate) -> a running.Measurement of each round.
    """
    begin, done, count = time.monotonic(), 0, rounds * len(plan)
    found = collections.defaultdict(list)
    for number in range(rounds):
        for name, stream in plan:
            found[name, stream.size, stream.rate].append(measure(name, stream, log))
            done += 1
            left = (time.monotonic() - begin) / done * (count - done)
            rate = f"at {stream.rate} Hz" if stream.rate else "as fast as it goes"
            say(
                f"[{done}/{count}] round {number + 1} of {rounds}: {name}, "
                f"{size_text(stream.size)} {rate}; {left:.0f} s left"
            )
    return found


def tables(found):
    """Return name -> table, a list of rows with the head first, of what measure_all() returned."""
    keys = sorted(found, key=lambda key: (key[1:], [*WAYS].index(key[0])))
    late = {key: numpy.concatenate([round_.latencies for round_ in found[key]]) for key in keys}
    latency, throughput = [LATENCY], [THROUGHPUT]
    for way, size, rate in keys:
        # As fast as it goes, messages wait in queues: how long says nothing of the way itself.
        if rate:
            p50, p99, most = numpy.percentile(late[way, size, rate], (50, 99, 100))
            ratio = p50 / numpy.median(late[LIMIT, size, rate])
            latency.append(
                [
                    *(WAYS[way].text, size_text(size), str(rate)),
                    *(f"{value:.1f}" for value in (p50, p99, most, ratio)),
                    *_cpu(found[way, size, rate]),
                ]
            )
        else:
            per_second = _median(found[way, size, rate], "throughput")
            ratio = per_second / _median(found[LIMIT, size, rate], "throughput")
            count = f"{per_second:,.0f}".replace(",", " ")
            cells = WAYS[way].text, size_text(size), count, f"{ratio:.2f}"
            throughput.append([*cells, *_cpu(found[way, size, rate])])
    return {
        "summary": _summary(latency, throughput),
        "latency": latency,
        "throughput": throughput,
    }


def _median(rounds, name):
    return statistics.median(getattr(round_, name) for round_ in rounds)


def _cpu(rounds):
    if rounds[0].receiver_cpu is None:
        return [f"{_median(rounds, 'sender_cpu'):.2f}", "the same"]
    return [f"{_median(rounds, name):.2f}" for name in ("sender_cpu", "receiver_cpu")]


def _summary(latency, throughput):
    """Return the table of the plain nodes beside the limit: messages of 8 bytes."""
    at_rate = {row[0]: row for row in latency if row[1] == "8 B"}
    fast = {row[0]: row for row in throughput if row[1] == "8 B"}
    plain = [text for text in (WAYS[way].text for way in PAIRS) if {text} <= {*at_rate, *fast}]
    return [SUMMARY, *([way, *at_rate[way][3:5], at_rate[way][6], fast[way][2]] for way in plain)]


def machine():
    """Return a sentence: the processor, the system, and the versions."""
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: (.*)$", cpuinfo, re.MULTILINE)
    memory = re.search(r"\d+", pathlib.Path("/proc/meminfo").read_text())
    release = pathlib.Path("/etc/os-release").read_text()
    system = re.search(r'^PRETTY_NAME="?([^"\n]*)', release, re.MULTILINE)[1]
    version = subprocess.run(["rosversion", "roscpp"], stdout=subprocess.PIPE, text=True).stdout
    return (
        f"Measured on {len(os.sched_getaffinity(0))} cores of "
        f"{model[1] if model else platform.machine()}, {int(memory[0]) / 1e6:.0f} GB, {system}, "
        f"Linux {platform.release().split('-')[0]}, roscpp {version.strip() or 'unknown'}, "
        f"Python {platform.python_version()}."
    )


def write(table, path):
    """Write a table as CSV."""
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(table)


def aligned(table):
    """Return a table for a terminal."""
    widths = [max(map(len, column)) for column in zip(*table)]
    lines = ("  ".join(map(str.ljust, row, widths)).rstrip() for row in table)
    return "\n".join(lines)
