#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Compares ways to send and receive, and prints a table; raw TCP is measured beside them.

Usage: compare.py NAME, as in `compare.py direct_queue`
       compare.py SIZE RATE COUNT WAY..., as in `compare.py 8 1000 500 cpp_cpp cpp_direct`; a RATE
       of 0 is as fast as it goes

It brings a master of its own, on a free port of this machine alone.
"""

import pathlib
import sys
import tempfile

from mrp_bench import plans, report, rounds
from mrp_bench.comparisons import COMPARISONS
from mrp_bench.master import Master
from mrp_bench.programs import ProgramError
from mrp_bench.ways import LIMITS, WAYS


def asked(arguments):
    """Return (size, rate, count) and the names of ways that the arguments ask for.

    Raises ValueError if they ask for nothing that there is.
    """
    if len(arguments) == 1 and arguments[0] in COMPARISONS:
        return COMPARISONS[arguments[0]][1:]
    size, rate, count = map(int, arguments[:3])
    ways = arguments[3:]
    if size < 8 or rate < 0 or count < 1 or not set(ways) <= set(WAYS):
        raise ValueError
    return (size, rate, count), ways


def usage():
    names = "\n".join(f"  {name:16} {comparison.text}" for name, comparison in COMPARISONS.items())
    return f"{__doc__}\nThe names are:\n{names}\nThe ways are: {', '.join(WAYS)}"


def main():
    try:
        stream, ways = asked(sys.argv[1:])
    except ValueError:
        sys.exit(usage())
    plan = rounds.steps(dict.fromkeys([*LIMITS, *ways]), stream)
    with tempfile.TemporaryDirectory() as folder:
        results = rounds.Results(folder)
        try:
            with Master(pathlib.Path(folder) / "programs.log"):
                rounds.run(plan, plans.QUICK_ROUNDS, results, lambda line: print(line, flush=True))
        except ProgramError as error:
            sys.exit(f"error: {error}")
        except KeyboardInterrupt:
            sys.exit("ended before all was measured")
        content = report.measured(results)
    print(report.markdown(content), flush=True)


if __name__ == "__main__":
    main()
