# SPDX-License-Identifier: BSD-3-Clause
"""Measures all ways in turns, and works out what results.json says of them."""

import collections
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import time

import numpy

from mrp_bench.programs import Running
from mrp_bench.ways import LIMIT, PLAN, WAYS, size_text

# The percentiles that tables show, and their names.
PERCENTILES = {"p50": 50, "p90": 90, "p99": 99, "max": 100}

# The share of a stream's messages that arrive first and are left out of its latencies: until then
# the programs have been woken up, and their caches filled.
_WARM_UP = 0.1

Delivery = collections.namedtuple("Delivery", "latencies lost disordered")


def machine():
    """Return a dictionary of texts: the processor, the system, and ROS's version."""
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: (.*)$", cpuinfo, re.MULTILINE)
    memory = re.search(r"\d+", pathlib.Path("/proc/meminfo").read_text())
    release = pathlib.Path("/etc/os-release").read_text()
    version = subprocess.run(["rosversion", "roscpp"], stdout=subprocess.PIPE, text=True).stdout
    return {
        "processor": model.group(1) if model else platform.machine(),
        "cores": str(len(os.sched_getaffinity(0))),
        "gigabytes": f"{int(memory.group()) / 1e6:.0f}",
        "system": re.search(r'^PRETTY_NAME="?([^"\n]*)', release, re.MULTILINE).group(1),
        "kernel": platform.release().split("-")[0],
        "python": platform.python_version(),
        "roscpp": version.strip() or "unknown",
    }


def measure(rounds, log, say, plan=PLAN):
    """Measure a plan, all ways in turns, round after round; return the rows of results.json.

    This way, whatever else the machine does meanwhile affects all ways alike.
    log: a file for what the programs print; say: called with a line after each measurement
    """
    begin, done, count = time.monotonic(), 0, rounds * len(plan)
    found = collections.defaultdict(list)
    for number in range(rounds):
        for name in dict.fromkeys(way for way, _ in plan):
            with Running(WAYS[name], log) as running:
                for stream in (stream for way, stream in plan if way == name):
                    found[name, stream.size, stream.rate].append(Round(running.measure(stream)))
                    done += 1
                    left = (time.monotonic() - begin) / done * (count - done)
                    rate = f"at {stream.rate} Hz" if stream.rate else "as fast as it goes"
                    say(
                        f"[{done}/{count}] round {number + 1} of {rounds}: {name}, "
                        f"{size_text(stream.size)} {rate}; {left:.0f} s left"
                    )
    order = list(WAYS)
    keys = sorted(found, key=lambda key: (key[1:], order.index(key[0])))
    return [_row(*key, found) for key in keys]


class Round:
    """What a programs.Measurement says.

    latencies: in us; throughput: messages per second; cpu: seconds per million messages
    """

    def __init__(self, measurement):
        sent = measurement.sent
        deliveries = [delivery(sent, pairs) for pairs in measurement.received]
        warm_up = int(len(sent) * _WARM_UP)
        self.latencies = numpy.concatenate([one.latencies[warm_up:] for one in deliveries]) / 1e3
        self.sent = len(sent) * len(deliveries)
        self.lost = sum(one.lost for one in deliveries)
        self.disordered = sum(one.disordered for one in deliveries)
        seconds = (max(pairs[-1] for pairs in measurement.received) - sent[0]) / 1e9
        self.throughput = (self.sent - self.lost) / len(deliveries) / seconds
        self.sender_cpu = measurement.sender_cpu / len(sent) * 1e6
        cpu = measurement.receiver_cpu
        self.receiver_cpu = None if cpu is None else cpu / self.sent * 1e6


def _row(name, size, rate, found):
    """Return what results.json says of a way and a stream, beside the limit."""

    def latency(of):
        return statistics.median(numpy.median(round_.latencies) for round_ in of)

    def throughput(of):
        return statistics.median(round_.throughput for round_ in of)

    rounds = found[name, size, rate]
    limit = found[LIMIT, size, rate]
    cpus = [round_.receiver_cpu for round_ in rounds]
    return {
        "way": name,
        "size": size,
        "rate": rate,
        "rounds": len(rounds),
        "latency": percentiles(numpy.concatenate([round_.latencies for round_ in rounds])),
        # As fast as it goes, messages wait in queues: that says nothing of the way itself.
        "latency_ratio": latency(rounds) / latency(limit) if rate else None,
        "throughput": throughput(rounds),
        "throughput_ratio": throughput(rounds) / throughput(limit),
        "sender_cpu": statistics.median(round_.sender_cpu for round_ in rounds),
        "receiver_cpu": None if None in cpus else statistics.median(cpus),
        "sent": sum(round_.sent for round_ in rounds),
        "lost": sum(round_.lost for round_ in rounds),
        "disordered": sum(round_.disordered for round_ in rounds),
    }


def delivery(sent, received):
    """Compare what was sent with what one receiver got.

    sent: the stamps of all messages, in ns, each of them another
    received: pairs of a stamp and the time of arrival, in the order of arrival
    Returns the latencies in ns, in the order of arrival; how many messages were lost; and how many
    arrived after one that was sent later, or for a second time.
    Raises ValueError if something was received that was not sent.
    """
    pairs = numpy.asarray(received, dtype=numpy.int64).reshape(-1, 2)
    stamps = pairs[:, 0]
    unknown = numpy.setdiff1d(stamps, sent)
    if unknown.size:
        raise ValueError(f"expected stamps that were sent, found {unknown[0]}, which was not")
    newest_before = numpy.maximum.accumulate(stamps)[:-1]
    disordered = int((stamps[1:] <= newest_before).sum())
    lost = len(sent) - numpy.unique(stamps).size
    return Delivery(pairs[:, 1] - stamps, int(lost), disordered)


def percentiles(values):
    """Return name -> value of each of PERCENTILES: the smallest one that was measured and is not
    below that share of all."""
    values = numpy.sort(values)
    # Whole numbers, rounded up.
    ranks = {name: -(-share * values.size // 100) for name, share in PERCENTILES.items()}
    return {name: float(values[rank - 1]) for name, rank in ranks.items()}


def as_text(content):
    """Return results.json: one record per line, so that a change shows which ones it changed."""
    parts = []
    for name, value in content.items():
        text = json.dumps(value)
        if isinstance(value, list):
            text = "[\n" + ",\n".join(map(json.dumps, value)) + "\n]"
        parts.append(f"{json.dumps(name)}: {text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"
