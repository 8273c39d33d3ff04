#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints each test of the pages' ledgers that has not passed in the last `make test-all`.

Usage: check_proofs.py

It leaves out what only a machine with containers can run, and the tests of `make test-check`.
Exit code: 1 if it prints one.
"""

import pathlib
import re
import sys

DOC = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp" / "doc"
sys.path.insert(0, str(DOC / "extension"))

import cases  # noqa: E402
import ledger  # noqa: E402


def is_of_test_all(name, case):
    """Say whether `make test-all` runs a test: by its mark, or by that of its file."""
    marks = re.findall(r"\bmark\.(quick|slow|sets)\b", case.source)
    of_file = re.findall(r"^pytestmark = .*\bmark\.(\w+)", case.path.read_text(), re.MULTILINE)
    return not name.startswith("docker/") and "sets" not in (marks or of_file)


def faults(folder, tests, results):
    """Yield the file, the line and the fault of each test that has not passed."""
    for path in sorted(folder.glob("*.txt")):
        for row in ledger.read(path):
            for name in row.tests:
                ended = results.get(name, "not run")
                if name in tests and is_of_test_all(name, tests[name]) and ended != "passed":
                    command = cases.command_of(name, tests[name])
                    yield f"{path}:{row.line}: {ended}: {name}: {command}"


if __name__ == "__main__":
    found = list(faults(ledger.FOLDER, cases.all_tests(), cases.last_results()))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
