# SPDX-License-Identifier: BSD-3-Clause
"""On what was measured, and how much else it did: a figure that is measured beside other work is
none."""

import multiprocessing
import os
import pathlib
import platform
import re
import subprocess
import time

import numpy

# The share of the processors' time, between 0 and 1, above which figures are not to be trusted.
LIMIT = 0.05

# Nanoseconds. A program that does nothing but look at the clock finds gaps of some 0.1 us, and of
# some us at each tick of the kernel; a longer one means that something else ran.
_GAP = 50_000


def describe():
    """Return a dictionary of texts: the processor, the system, and ROS's version."""
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: (.*)$", cpuinfo, re.MULTILINE)
    memory = re.search(r"\d+", pathlib.Path("/proc/meminfo").read_text())
    release = pathlib.Path("/etc/os-release").read_text()
    version = subprocess.run(
        ["rosversion", "roscpp"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ).stdout.strip()
    return {
        "processor": model.group(1) if model else platform.machine(),
        "cores": str(len(os.sched_getaffinity(0))),
        "gigabytes": f"{int(memory.group()) / 1e6:.0f}",
        "system": re.search(r'^PRETTY_NAME="?([^"\n]*)', release, re.MULTILINE).group(1),
        "kernel": platform.release().split("-")[0],
        "python": platform.python_version(),
        "roscpp": version or "unknown",
    }


def lost_share(moments):
    """Return which share of the time was lost in gaps; moments: ascending times in ns."""
    gaps = numpy.diff(numpy.asarray(moments, dtype=numpy.int64))
    return float(gaps[gaps > _GAP].sum() / (moments[-1] - moments[0]))


def _watch_clock(processor, seconds):
    """Look at the clock all the time; return the lost share."""
    os.sched_setaffinity(0, {processor})
    moments = [time.monotonic_ns()]
    end = moments[0] + int(seconds * 1e9)
    while moments[-1] < end:
        moments.append(time.monotonic_ns())
    return lost_share(moments)


def _probe(processor, seconds, results):
    # Each process takes its own memory first: that is not what is to be measured.
    _watch_clock(processor, seconds / 10)
    results.put(_watch_clock(processor, seconds))


def noise(seconds=0.3):
    """Return the share of the processors' time that is lost to others, between 0 and 1."""
    # "fork" imports nothing a second time, so all processes begin at about the same time.
    context = multiprocessing.get_context("fork")
    results = context.Queue()
    processes = [
        context.Process(target=_probe, args=(processor, seconds, results))
        for processor in sorted(os.sched_getaffinity(0))
    ]
    for process in processes:
        process.start()
    shares = [results.get(timeout=60) for _ in processes]
    for process in processes:
        process.join()
    return sum(shares) / len(shares)


def verdict(shares):
    """Return why figures that were measured between these probes are not to be trusted, or None.

    shares: of noise(), at least one
    """
    share = float(numpy.median(shares))
    if share <= LIMIT:
        return None
    return (
        f"this machine is too noisy: others took {share:.0%} of the processors' time, and at most "
        f"{LIMIT:.0%} can be ignored. End what else runs on it, and measure again"
    )
