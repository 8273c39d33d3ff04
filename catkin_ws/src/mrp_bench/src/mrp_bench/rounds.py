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

from mrp_bench import noise
from mrp_bench.programs import Running, Stream
from mrp_bench.ways import WAYS, size_text

# What a plan consists of: a way's name, and a Stream.
Step = collections.namedtuple("Step", "way stream")

# Rounds after which all programs are started anew: no two processes are equally fast.
_ROUNDS_PER_START = 3


class PlanError(Exception):
    """A run cannot be resumed."""


class Results:
    """A folder with what was measured; each measurement is there as a whole, or not at all."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def begin(self, plan, rounds, resume):
        """Make the folder ready. Raises PlanError if something else was measured in it before."""
        path = self.folder / "plan.json"
        text = json.dumps({"rounds": rounds, "steps": plan})
        if resume and path.exists() and path.read_text() != text:
            raise PlanError(
                f"expected in {path} what is to be measured now, found another plan: begin anew, "
                "without RESUME=1"
            )
        self.folder.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def path(self, number, step):
        stream = step.stream
        name = f"{step.way}_{stream.size}_{stream.rate}.json.gz"
        return self.folder / "samples" / f"round_{number}" / name

    def has(self, number, step):
        return self.path(number, step).exists()

    def keep(self, number, step, measurement):
        content = {
            "way": step.way,
            **step.stream._asdict(),
            "round": number,
            **measurement._asdict(),
        }
        path = self.path(number, step)
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".unfinished")
        with gzip.open(unfinished, "wt", compresslevel=1) as file:
            json.dump(content, file)
        unfinished.rename(path)

    def once(self, path, measure, say, line):
        """Say the line, and keep what measure() returns in the file `path`, unless it is there."""
        if not path.exists():
            say(line)
            found = json.dumps(measure(), indent=1)
            unfinished = path.with_suffix(".unfinished")
            unfinished.write_text(found)
            unfinished.rename(path)

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
    """Measure what is not there yet. say: is called with a line on each thing that is done."""
    pending = [
        (number, step) for number in range(rounds) for step in plan if not results.has(number, step)
    ]
    begin = time.monotonic()
    done = 0
    for first in range(0, rounds, _ROUNDS_PER_START):
        numbers = range(first, min(first + _ROUNDS_PER_START, rounds))
        ways = list(dict.fromkeys(step.way for number, step in pending if number in numbers))
        if not ways:
            continue
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
            for number in numbers:
                results.keep_noise(noise.measure())
                for step in (step for of, step in pending if of == number):
                    results.keep(number, step, running[step.way].measure(step.stream))
                    done += 1
                    seconds = time.monotonic() - begin
                    left = seconds / done * (len(pending) - done)
                    say(
                        f"[{done}/{len(pending)}] round {number + 1} of {rounds}: {step.way}, "
                        f"{describe(step.stream)}; {left:.0f} s left"
                    )
            results.keep_noise(noise.measure())


def describe(stream):
    """Return a Stream in words."""
    rate = f"at {stream.rate} Hz" if stream.rate else "as fast as it goes"
    return f"{size_text(stream.size)} {rate}"


def steps(ways, *streams):
    return [Step(way, Stream(*stream)) for stream in streams for way in ways]
