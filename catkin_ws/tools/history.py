# SPDX-License-Identifier: BSD-3-Clause
"""Figures of this repository over time, in a table of comma-separated values in the repository."""

import csv
import pathlib
import subprocess


def read(path):
    """Return the rows, the oldest first, as dictionaries; none if there is no such table yet."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def last(rows, **wanted):
    """Return the newest row that has these values, or None."""
    found = [row for row in rows if wanted.items() <= row.items()]
    return found[-1] if found else None


def commit():
    """Return the short name of the commit that is checked out."""
    return subprocess.run(
        ["git", "-C", pathlib.Path(__file__).parent, "rev-parse", "--short", "HEAD"],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout.strip()


def append(path, rows):
    """Append dictionaries, whose keys are the table's columns."""
    is_new = not path.exists()
    with open(path, "a", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        if is_new:
            table.writeheader()
        table.writerows(rows)
