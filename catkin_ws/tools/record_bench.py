#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts what `make bench` measured into the pages: extension/bench.py makes tables of it.

Usage: record_bench.py FOLDER
"""

import json
import pathlib
import shutil
import sys

RECORDED = pathlib.Path(__file__).resolve().parents[1] / "src/mrp/doc/recorded/results.json"

# A run with fewer rounds is a quick look: its figures are not worth a record.
_ROUNDS = 6


def record(folder, recorded):
    """Copy the results of a folder into a file of the pages.

    Exits with a message if there are no results, or if they are not worth a record.
    """
    try:
        results = json.loads((folder / "results.json").read_text())
    except FileNotFoundError:
        sys.exit(f"error: expected the results of a run in {folder}, found none: run make bench")
    if results["verdict"]:
        sys.exit(f"error: {results['verdict']}")
    rounds = min(row["rounds"] for row in results["rows"])
    if rounds < _ROUNDS:
        sys.exit(
            f"error: expected {_ROUNDS} rounds, found {rounds}: run make bench without QUICK=1"
        )
    shutil.copy(folder / "results.json", recorded)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    record(pathlib.Path(sys.argv[1]), RECORDED)
