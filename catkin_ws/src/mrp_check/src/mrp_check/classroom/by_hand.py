# SPDX-License-Identifier: BSD-3-Clause
"""What a person sets for a student, beside what the checker measures: one line of a CSV file."""

from __future__ import annotations

import csv
import dataclasses
import pathlib
import re
import unicodedata
from typing import Iterable, Mapping

from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.schema import near, no_such
from mrp_check.contract.spec import Late

COLUMNS = ("student", "late_days", "maximum", "override", "reason", "by")
_MOST_DAYS = 366


@dataclasses.dataclass(frozen=True)
class ByHand:
    """What is set for one student.

    off: the points that the late days take off
    maximum: the most points that the student can have, or None
    override: what counts instead of the measured points, or None
    reason, by: why, and who says so
    """

    late_days: int = 0
    off: float = 0
    maximum: float | None = None
    override: float | None = None
    reason: str = ""
    by: str = ""

    def mark(self, points: float) -> float:
        """Return the mark of somebody with these measured points."""
        points = max(0, (points if self.override is None else self.override) - self.off)
        return points if self.maximum is None else min(points, self.maximum)

    def __str__(self) -> str:
        """Return it as a text: empty if nothing is set."""
        days = f"{self.late_days} day{'s' * (self.late_days != 1)} late: -{self.off:g}"
        parts = [
            f"points set to {self.override:g}" if self.override is not None else "",
            days if self.late_days else "",
            f"at most {self.maximum:g}" if self.maximum is not None else "",
        ]
        why = ": ".join(filter(None, (self.by, self.reason)))
        return "; ".join(filter(None, parts)) + (f" ({why})" if why else "")


class _Wrong(Exception):  # noqa: N818 (a line is)
    """A line can't be used; a sentence."""


def read(
    path: str | pathlib.Path, names: Iterable[str], most: float, late: Late | None
) -> dict[str, ByHand]:
    """Return what a CSV file sets for each student that it names.

    names: those of all submissions
    most: the contract's points
    late: the contract's rule for late days

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
                    raise _Wrong(f"expected {len(reader.fieldnames or [])} cells; found more.")
                cells = {column: cell.strip() for column, cell in row.items()}
                if any(cells.values()):
                    student = _student(cells["student"], known)
                    if student in found:
                        raise _Wrong(f"'{student}' appears twice.")
                    found[student] = _by_hand(cells, most, late)
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
    if "student" not in columns:
        raise _Wrong(f"expected the columns: {', '.join(COLUMNS)}. 'student' is missing.")


def _normal(name: str) -> str:
    """Return a name as most keyboards write it: on macOS, ü may be two characters."""
    return unicodedata.normalize("NFC", name)


def _student(name: str, known: Mapping[str, str]) -> str:
    if _normal(name) not in known:
        raise _Wrong(f"there's no submission '{name}'." + near(name, known))
    return known[_normal(name)]


def _by_hand(cells: Mapping[str, str], most: float, late: Late | None) -> ByHand:
    def number(column: str, most: float) -> float | None:
        text = cells.get(column, "")
        if not text:
            return None
        value = float(text) if re.fullmatch(r"[0-9]+(\.[0-9]+)?", text) else -1
        if not 0 <= value <= most:
            raise _Wrong(f"{column}: expected a number from 0 to {most:g}; found '{text}'.")
        return value

    days, override = number("late_days", _MOST_DAYS) or 0, number("override", most)
    reason = cells.get("reason", "")
    if days % 1:
        raise _Wrong(f"late_days: expected whole days; found {days:g}.")
    if days and not late:
        raise _Wrong(
            f"late_days is {days:g}, but the contract doesn't say what a day takes off: it has no"
            " key 'late', such as late: {percent: 10}."
        )
    if override is not None and not reason:
        raise _Wrong(f"override is {override:g}, but no reason is given.")
    off = late.off(days, most) if late else 0
    maximum = number("maximum", most)
    return ByHand(int(days), off, maximum, override, reason, cells.get("by", ""))
