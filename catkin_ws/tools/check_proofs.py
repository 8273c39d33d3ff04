#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints each test of the pages' ledgers that has not passed in the last `make test-all`.

Usage: check_proofs.py [--record]

It leaves out what only a machine with containers can run, and the tests of `make test-check`.
Exit code: 1 if it prints one. With --record it writes down for the pages which tests have passed,
and when; of the others, what was recorded before stays.
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


def faults(folder):
    """Yield the file, the line and the fault of each test that has not passed."""
    for path in sorted(folder.glob("*.txt")):
        for row in ledger.read(path):
            for name in row.tests:
                case, (ended, _) = cases.find(name), cases.result(name) or ("not run", "")
                if case and is_of_test_all(name, case) and ended != "passed":
                    yield f"{path}:{row.line}: {ended}: {name}, in {case.path}"


def record(folder):
    """Write down the day on which each test of the ledgers passed last."""
    before, lines = cases.recorded(), []
    for name in {
        name for path in folder.glob("*.txt") for row in ledger.read(path) for name in row.tests
    }:
        ended, day = cases.result(name) or ("passed", before.get(name))
        if ended == "passed" and day:
            lines.append(f"{day} {name}\n")
    cases.PASSED.write_text("".join(sorted(lines, key=lambda line: line.split()[1])))


if __name__ == "__main__":
    if sys.argv[1:] == ["--record"]:
        record(ledger.FOLDER)
        sys.exit()
    found = list(faults(ledger.FOLDER))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
