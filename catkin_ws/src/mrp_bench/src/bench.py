#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how fast this machine publishes and subscribes: `make bench` calls it.

It brings a master of its own, on a free port.
"""

import argparse
import pathlib
import signal
import sys
import time

from mrp_bench import figures, robots
from mrp_bench.running import ProgramError, master

ROUNDS = 6
ROBOTS = (1, 2, 5, 10, 20, 50)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="where the tables go")
    parser.add_argument("--quick", action="store_true", help="one round, and no robots")
    return parser.parse_args()


def say(line, begin=time.monotonic()):  # noqa: B008  (this program's begin)
    print(f"{time.monotonic() - begin:5.0f} s  {line}", flush=True)


def main():
    # Also where SIGINT is ignored, as in what a shell runs in the background.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    args = arguments()
    args.folder.mkdir(parents=True, exist_ok=True)
    log = args.folder / "programs.log"
    log.unlink(missing_ok=True)
    try:
        with master(log):
            tables = figures.tables(figures.measure_all(1 if args.quick else ROUNDS, log, say))
            if not args.quick:
                rows = [robots.measure(count, log, say) for count in ROBOTS]
                tables["robots"] = [robots.HEAD, *rows]
    except ProgramError as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit("ended before all was measured")
    machine = figures.machine()
    (args.folder / "machine.txt").write_text(f"{machine}\n")
    print(machine)
    for name, table in tables.items():
        figures.write(table, args.folder / f"{name}.csv")
        print(f"\n{figures.aligned(table)}")
    say(f"these tables are in {args.folder}")


if __name__ == "__main__":
    main()
