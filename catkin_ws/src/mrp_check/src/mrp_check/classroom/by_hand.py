# SPDX-License-Identifier: BSD-3-Clause
"""The points that a person sets for a student, in place of the measured ones: a CSV file."""

from __future__ import annotations

import csv
import pathlib
import re
import unicodedata
from typing import Iterable, Mapping, NamedTuple

from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.schema import near, no_such

COLUMNS = ("student", "points", "reason")


class ByHand(NamedTuple):
    """What is set for one student: the points, and why."""

    points: float
    reason: str

    def __str__(self) -> str:
        return f"{self.points:g} ({self.reason})"


class _Wrong(Exception):  # noqa: N818 (a line is)
    """A line can't be used; a sentence."""


def read(path: str | pathlib.Path, names: Iterable[str], most: float) -> dict[str, ByHand]:
    """Return what a CSV file sets for each student that it names.

    names: those of all submissions
    most: the contract's points

    Raises CannotCheck if a line can't be used: the sentence names it.
    """
    known = {_normal(name): name for name in names}
    found: dict[str, ByHand] = {}
    line = 1
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            reader = csv.DictReader(file, strict=True, restval="")
            _see_columns(reader.fieldnames or [])
            for row in reader:
                line = reader.line_num
                if None in row:
                    raise _Wrong(f"expected {len(COLUMNS)} cells; found more.")
                cells = {column: cell.strip() for column, cell in row.items()}
                if any(cells.values()):
                    student = _student(cells["student"], known)
                    if student in found:
                        raise _Wrong(f"'{student}' appears twice.")
                    found[student] = _by_hand(cells, most)
    except OSError as error:
        raise CannotCheck(f"{path} can't be read: {error.strerror}.") from None
    except UnicodeDecodeError:
        raise CannotCheck(f"{path}: expected UTF-8 text, and found other bytes.") from None
    except csv.Error as error:
        raise CannotCheck(f"{path}: below line {line}, this isn't valid CSV: {error}.") from None
    except _Wrong as error:
        raise CannotCheck(f"{path}:{line}: {error}") from None
    return found


def _see_columns(columns: Iterable[str]) -> None:
    for column in columns:
        if column not in COLUMNS:
            raise _Wrong(no_such("column", column, COLUMNS))
    for column in COLUMNS:
        if column not in columns:
            raise _Wrong(f"expected the columns: {', '.join(COLUMNS)}. '{column}' is missing.")


def _normal(name: str) -> str:
    """Return a name as most keyboards write it: on macOS, ü may be two characters."""
    return unicodedata.normalize("NFC", name)


def _student(name: str, known: Mapping[str, str]) -> str:
    if _normal(name) not in known:
        raise _Wrong(f"there's no submission '{name}'." + near(name, known))
    return known[_normal(name)]


def _by_hand(cells: Mapping[str, str], most: float) -> ByHand:
    text, reason = cells["points"], cells["reason"]
    points = float(text) if re.fullmatch(r"[0-9]+(\.[0-9]+)?", text) else -1
    if not 0 <= points <= most:
        raise _Wrong(f"points: expected a number from 0 to {most:g}; found '{text}'.")
    if not reason:
        raise _Wrong(f"points are set to {points:g}, but no reason is given.")
    return ByHand(points, reason)
