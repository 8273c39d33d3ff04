# SPDX-License-Identifier: BSD-3-Clause
"""What a person sets for a student, beside what the checker measures: one line of a CSV file."""

from __future__ import annotations

import csv
import dataclasses
import io
import pathlib
import re
import unicodedata
from typing import Iterable, Iterator, NoReturn

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
    lines: dict[str, int] = {}
    for line in _lines(path):
        student = known.get(_normal(line.cells["student"]))
        if student is None:
            name = line.cells["student"]
            line.fail(f"there's no submission '{name}'." + near(name, known))
        if student in found:
            line.fail(f"'{student}' appears twice: see line {lines[student]}.")
        found[student], lines[student] = line.by_hand(most, late), line.number
    return found


def _normal(name: str) -> str:
    """Return a name as most keyboards write it: on macOS, ü may be two characters."""
    return unicodedata.normalize("NFC", name)


class _Line:
    def __init__(self, path: str | pathlib.Path, number: int, cells: dict[str, str]) -> None:
        self.path, self.number, self.cells = path, number, cells

    def fail(self, sentence: str) -> NoReturn:
        raise CannotCheck(f"{self.path}:{self.number}: {sentence}")

    def by_hand(self, most: float, late: Late | None) -> ByHand:
        days = self.value("late_days", _MOST_DAYS) or 0
        if days % 1:
            self.fail(f"late_days: expected whole days; found {days:g}.")
        if days and not late:
            self.fail(
                f"late_days is {days:g}, but the contract doesn't say what a day takes off: it has"
                " no key 'late', such as late: {percent: 10}."
            )
        override, reason = self.value("override", most), self.cells.get("reason", "")
        if override is not None and not reason:
            self.fail(f"override is {override:g}, but no reason is given.")
        return ByHand(
            int(days),
            late.off(days, most) if late else 0,
            self.value("maximum", most),
            override,
            reason,
            self.cells.get("by", ""),
        )

    def value(self, column: str, most: float) -> float | None:
        """Return the number in a column; None if the cell is empty."""
        text = self.cells.get(column, "")
        if not text:
            return None
        value = float(text) if re.fullmatch(r"[0-9]+(\.[0-9]+)?", text) else -1
        if not 0 <= value <= most:
            self.fail(f"{column}: expected a number from 0 to {most:g}; found '{text}'.")
        return value


def _lines(path: str | pathlib.Path) -> Iterator[_Line]:
    """Yield each line below the first one, which names the columns."""
    rows = list(_rows(path))
    if not rows:
        raise CannotCheck(f"{path}:1: expected a line with the columns: {', '.join(COLUMNS)}.")
    start, columns = rows[0]
    first = _Line(path, start, {})
    for column in columns:
        if column not in COLUMNS:
            first.fail(no_such("column", column, COLUMNS))
        if columns.count(column) > 1:
            first.fail(f"the column '{column}' appears twice.")
    if "student" not in columns:
        first.fail("expected the column 'student'; it is missing.")
    for number, cells in rows[1:]:
        line = _Line(path, number, {**dict.fromkeys(columns, ""), **dict(zip(columns, cells))})
        if len(cells) > len(columns):
            line.fail(f"expected {len(columns)} cells, as in the first line; found {len(cells)}.")
        yield line


def _rows(path: str | pathlib.Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of the first line, and the cells, of each row that is not empty."""
    number, data = 1, b""
    try:
        data = pathlib.Path(path).read_bytes()
        reader = csv.reader(io.StringIO(data.decode("utf-8-sig"), newline=""), strict=True)
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield number, cells
            number = reader.line_num + 1
    except OSError as error:
        raise CannotCheck(f"{path} can't be read: {error.strerror}.") from None
    except UnicodeDecodeError as error:
        number = data.count(b"\n", 0, error.start) + 1
        raise CannotCheck(f"{path}:{number}: expected UTF-8 text, and found other bytes.") from None
    except csv.Error as error:
        raise CannotCheck(f"{path}:{number}: this isn't valid CSV: {error}.") from None
