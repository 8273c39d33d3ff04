#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints each test of the pages' ledgers that has not passed in the last `make test-all`.

Usage: check_proofs.py [--record]

It leaves out what only a machine with containers can run, and the tests of `make test-check`.
Exit code: 1 if it prints one. If it prints none, --record writes down for the pages on which day
the tests passed.
"""

import pathlib
import sys

DOC = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp" / "doc"
sys.path.insert(0, str(DOC / "extension"))

import cases  # noqa: E402
import ledger  # noqa: E402


def results(folder):
    """Yield (file and line, test, how it ended, day) of what `make test-all` runs of the ledgers.

    The day is "" for a test that did not run.
    """
    for path in sorted(folder.glob("*.txt")):
        for row in ledger.read(path):
            for name in filter(cases.is_of_test_all, row.tests):
                ended, day = cases.result(name) or ("not run", "")
                yield f"{path}:{row.line}", name, ended, day


def faults(folder):
    """Return a line on each test that has not passed."""
    return [
        f"{place}: {ended}: {name}, in {cases.find(name).path}"
        for place, name, ended, _ in results(folder)
        if ended != "passed"
    ]


def record(folder):
    """Write down the day of the last complete `make test-all`."""
    day = min(day for *_, day in results(folder))
    cases.PASSED.write_text(f"{day}\n")


if __name__ == "__main__":
    found = faults(ledger.FOLDER)
    print("\n".join(found), end="\n" if found else "")
    if not found and sys.argv[1:] == ["--record"]:
        record(ledger.FOLDER)
    sys.exit(1 if found else 0)
