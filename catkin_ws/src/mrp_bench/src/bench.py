#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how fast this machine publishes and subscribes: `make bench` calls it.

It brings a master of its own, on a free port of this machine alone.
"""

import argparse
import pathlib
import shutil
import signal
import sys
import time

from mrp_bench import launches, plans, report
from mrp_bench.processes import Master
from mrp_bench.programs import ProgramError
from mrp_bench.rounds import Results, run


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="where the results go")
    parser.add_argument("--quick", action="store_true", help="less of everything")
    return parser.parse_args()


def say(line, begin=time.monotonic()):  # noqa: B008  (this program's begin)
    print(f"{time.monotonic() - begin:5.0f} s  {line}", flush=True)


def main():
    # Also where SIGINT is ignored, as in what a shell runs in the background: the programs that
    # stand still must not be left behind.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    args = arguments()
    shutil.rmtree(args.folder, ignore_errors=True)
    args.folder.mkdir(parents=True)
    plan = plans.QUICK if args.quick else plans.FULL
    rounds = plans.QUICK_ROUNDS if args.quick else plans.FULL_ROUNDS
    results = Results(args.folder)
    try:
        with Master(args.folder / "programs.log"):
            run(plan, rounds, results, say)
            if not args.quick:
                launches.run(plans.ROBOTS, 1, results, say)
        report.write(results, say)
    except ProgramError as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit("ended before all was measured")


if __name__ == "__main__":
    main()
