# SPDX-License-Identifier: BSD-3-Clause
"""Measures many ways in turns, round after round, and keeps every sample.

What else the machine does from one minute to the next so falls on all ways alike.
"""

import collections
import contextlib
import gzip
import json
import pathlib
import time

from mrp_bench import machine
from mrp_bench.programs import Running, Stream
from mrp_bench.ways import WAYS, size_text

# What a plan consists of: a way's name, and a Stream.
Step = collections.namedtuple("Step", "way stream")

# Rounds after which all programs are restarted: no two processes are equally fast.
_ROUNDS_PER_START = 3


class Results:
    """A folder with what was measured."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def keep(self, number, step, measurement):
        """Write down what a step has given in a round."""
        way, stream = step
        content = {
            "way": way,
            **stream._asdict(),
            "round": number,
            **measurement._asdict(),
        }
        folder = self.folder / "samples" / f"round_{number}"
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{way}_{stream.size}_{stream.rate}.json.gz"
        with gzip.open(path, "wt", compresslevel=1) as file:
            json.dump(content, file)

    def keep_noise(self, share):
        with open(self.folder / "noise.txt", "a") as file:
            file.write(f"{share:.4f}\n")

    def noise(self):
        return [float(line) for line in (self.folder / "noise.txt").read_text().split()]

    def measurements(self):
        """Return all that was measured: dictionaries, see keep()."""
        found = []
        for path in sorted((self.folder / "samples").glob("round_*/*.json.gz")):
            with gzip.open(path, "rt") as file:
                found.append(json.load(file))
        return found


def run(plan, rounds, results, say):
    """Measure a plan. say: is called with a line on each thing that is done."""
    begin = time.monotonic()
    done, count = 0, rounds * len(plan)
    ways = list(dict.fromkeys(step.way for step in plan))
    for first in range(0, rounds, _ROUNDS_PER_START):
        say(f"starting the programs of {len(ways)} ways")
        with contextlib.ExitStack() as stack:
            running = {name: Running(WAYS[name], results.folder / "programs.log") for name in ways}
            for programs in running.values():
                stack.enter_context(programs)
            for programs in running.values():
                # At the end all are asked before the first is waited for.
                stack.callback(programs.ask_to_end)
                programs.start()
            for programs in running.values():
                programs.connect()
            for number in range(first, min(first + _ROUNDS_PER_START, rounds)):
                results.keep_noise(machine.noise())
                for step in plan:
                    results.keep(number, step, running[step.way].measure(step.stream))
                    done += 1
                    seconds = time.monotonic() - begin
                    left = seconds / done * (count - done)
                    say(
                        f"[{done}/{count}] round {number + 1} of {rounds}: {step.way}, "
                        f"{describe(step.stream)}; {left:.0f} s left"
                    )
            results.keep_noise(machine.noise())


def describe(stream):
    """Return a Stream in words."""
    rate = f"at {stream.rate} Hz" if stream.rate else "as fast as it goes"
    return f"{size_text(stream.size)} {rate}"


def steps(ways, *streams):
    return [Step(way, Stream(*stream)) for stream in streams for way in ways]
