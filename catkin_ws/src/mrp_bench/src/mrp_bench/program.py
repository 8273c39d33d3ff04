# SPDX-License-Identifier: BSD-3-Clause
"""What all measured programs have in common: include/mrp_bench/program.h, in Python."""

import array
import os
import sys
import threading
import time


def options():
    """Return the arguments NAME=NUMBER of this program as a dictionary."""
    pairs = (argument.split("=", 1) for argument in sys.argv[1:] if ":=" not in argument)
    return {name: int(number) for name, number in pairs}


class Answers:
    """Takes stdout for the answers alone: all else that is printed goes to stderr."""

    def __init__(self):
        self._file = os.fdopen(os.dup(1), "wb")
        os.dup2(2, 1)

    def write(self, word, numbers=()):
        numbers = array.array("q", numbers)
        self._file.write(f"{word} {len(numbers)}\n".encode() + numbers.tobytes())
        self._file.flush()


class Samples:
    """What a receiver has: pairs of the stamp of a message, and the time at which it arrived.

    It has a lock, as rospy calls back in a thread of each connection.
    """

    def __init__(self, answers):
        self._answers = answers
        self._samples = []
        self._lock = threading.Lock()

    def add(self, stamp, arrival):
        with self._lock:
            if stamp:
                self._samples.append(stamp)
                self._samples.append(arrival)
            else:
                self._answers.write("received", self._samples)
                self._samples.clear()


def obey(sender, answers):
    """Do what stdin says, to its end; `sender` has the functions resize(size) and send(stamp)."""
    now = time.monotonic_ns
    for line in sys.stdin:
        word, *numbers = line.split()
        if word == "end":
            sender.send(0)
            continue
        size, rate, count = int(numbers[0]), float(numbers[1]), int(numbers[2])
        sender.resize(size)
        stamps = array.array("q")
        start = now()
        for i in range(count):
            if rate:
                wait = start + i * 1e9 / rate - now()
                if wait > 0:
                    time.sleep(wait / 1e9)
            stamp = now()
            stamps.append(stamp)
            sender.send(stamp)
        answers.write("sent", stamps)
