#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints each test of the pages' ledgers that has not passed in the last `make test-all`.

It leaves out what only a machine with containers can run, and the tests of `make test-check`.
Exit code: 1 if it prints one.
"""

import pathlib
import sys

DOC = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp" / "doc"
sys.path.insert(0, str(DOC / "extension"))

import cases  # noqa: E402
import ledger  # noqa: E402


def faults(folder):
    """Yield a line on each test of `make test-all` that the ledgers name and has not passed."""
    for path in sorted(folder.glob("*.txt")):
        for row in ledger.read(path):
            for name in filter(cases.is_of_test_all, row.tests):
                ended, _ = cases.result(name) or ("not run", "")
                if ended != "passed":
                    yield f"{path}:{row.line}: {ended}: {name}, in {cases.find(name).path}"


if __name__ == "__main__":
    found = list(faults(ledger.FOLDER))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
