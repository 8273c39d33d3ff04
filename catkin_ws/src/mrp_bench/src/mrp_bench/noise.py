# SPDX-License-Identifier: BSD-3-Clause
"""How much else this machine does: a figure that is measured beside other work is none."""

import multiprocessing
import os
import time

import numpy

# The share of the processors' time, between 0 and 1, above which figures are not to be trusted.
LIMIT = 0.05

# Nanoseconds. A program that does nothing but look at the clock finds gaps of some 0.1 us, and of
# some us at each tick of the kernel; a longer one means that something else ran.
_GAP = 50_000


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


def measure(seconds=0.3):
    """Return the share of the processors' time that is lost to others, between 0 and 1."""
    # "fork": nothing is imported anew, so all begin at about the same time.
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

    shares: of measure(), at least one
    """
    share = float(numpy.median(shares))
    if share <= LIMIT:
        return None
    return (
        f"this machine is too noisy: others took {share:.0%} of the processors' time, and at most "
        f"{LIMIT:.0%} can be ignored. End what else runs on it, and measure again"
    )
