#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Compares ways to send and receive: the node of this package's launch files.

Usage: compare.py SIZE RATE COUNT WAY..., as in `compare.py 8 1000 500 cpp_cpp cpp_direct`; a RATE
of 0 is as fast as it goes. Raw TCP is measured beside them.
"""

import sys
import tempfile

from mrp_bench import machine, plans, report, rounds, summary
from mrp_bench.programs import ProgramError
from mrp_bench.ways import WAYS


def main():
    arguments = [argument for argument in sys.argv[1:] if ":=" not in argument]
    try:
        size, rate, count = map(int, arguments[:3])
        names = dict.fromkeys([*summary.LIMITS, *arguments[3:]])
        unknown = [name for name in names if name not in WAYS]
        if unknown or size < 8 or rate < 0 or count < 1:
            raise ValueError
    except ValueError:
        sys.exit(f"{__doc__}\nThe ways are: {', '.join(WAYS)}")
    with tempfile.TemporaryDirectory() as folder:
        results = rounds.Results(folder)
        plan = rounds.steps(names, (size, rate, count))
        try:
            results.begin(plan, plans.QUICK_ROUNDS, resume=False)
            rounds.run(plan, plans.QUICK_ROUNDS, results, lambda line: print(line, flush=True))
        except ProgramError as error:
            sys.exit(f"error: {error}")
        rows = summary.summarise(results.measurements())
        probes = results.noise()
    print(report.markdown(rows, machine.describe(), probes), flush=True)


if __name__ == "__main__":
    main()
