# SPDX-License-Identifier: BSD-3-Clause
"""Which submissions are alike, less what all were given: somebody must look at both.

It accuses nobody. Two may have learned from the same page, or have worked as a pair.
"""

from __future__ import annotations

import csv
import dataclasses
import io
import itertools
import pathlib
import tempfile
from typing import Iterable

from mrp_check.classroom import fingerprints, submissions
from mrp_check.classroom.class_table import cell
from mrp_check.classroom.fingerprints import Code, Place
from mrp_check.contract.errors import PackageError
from mrp_check.contract.words import printable
from mrp_check.package.package import Package
from mrp_check.report import console

LOOK = "look at both"
_LEAST = 60  # fingerprints of its own: with fewer, a solution is like many others
_USUAL = 20  # fingerprints that any two plain nodes share: they count for nothing
_ALIKE = 0.45  # of the shorter one


@dataclasses.dataclass
class Pair:
    """Two submissions that are alike.

    group: the number of their group
    is_nearest: whether it is one of the pairs that show why all in the group are in it
    """

    first: Code
    second: Code
    shared: set[int]
    group: int = 0
    is_nearest: bool = False

    @property
    def percent(self) -> int:
        """How much of the shorter one is in the other one, too."""
        least = min(len(self.first.places), len(self.second.places))
        return round(100 * len(self.shared) / least)

    @property
    def blocks(self) -> list[tuple[Place, list[Place]]]:
        """The lines of the first that are alike, each with those of the second that it is like."""
        places = {one: self.first.places[one] for one in self.shared}
        return [
            (
                place,
                _joined(self.second.places[one] for one in places if _is_in(places[one], place)),
            )
            for place in _joined(places.values())
        ]


def _is_in(part: Place, whole: Place) -> bool:
    return part[0] == whole[0] and whole[1] <= part[1] <= whole[2]


def _joined(places: Iterable[Place]) -> list[Place]:
    """Return the places in their order; those that touch are one."""
    found: list[Place] = []
    for file, first, last in sorted(places):
        if found and found[-1][0] == file and first <= found[-1][2] + 1:
            file, first, before = found.pop()
            last = max(last, before)
        found.append((file, first, last))
    return found


def pairs_in(entries: Iterable[pathlib.Path], package: str, templates: Iterable[str]) -> list[Pair]:
    """Return the pairs of submissions that are alike, the nearest first. Raises PackageError.

    package: which is looked at of a submission that has several
    templates: packages that were given, of which nothing counts
    """
    given: set[int] = set()
    for template in templates:
        given |= _code(pathlib.Path(template).resolve(), "").places.keys()
    codes = []
    for entry in entries:
        try:
            codes.append(_code(entry, package))
        except PackageError:  # its line in the table says why
            continue
        for one in given & codes[-1].places.keys():
            del codes[-1].places[one]
    return _grouped(_alike([one for one in codes if len(one.places) >= _LEAST]))


def _code(entry: pathlib.Path, package: str) -> Code:
    with tempfile.TemporaryDirectory(prefix="mrp_check_") as scratch:
        root = submissions.package_in(entry, pathlib.Path(scratch), package)
        return fingerprints.of_package(Package(root), printable(entry.name))


def _alike(codes: list[Code]) -> list[Pair]:
    found = []
    for first, second in itertools.combinations(codes, 2):
        shared = first.places.keys() & second.places.keys()
        least = min(len(first.places), len(second.places))
        if len(shared) - _USUAL >= _ALIKE * least:
            found.append(Pair(first, second, shared))
    return sorted(found, key=lambda pair: -pair.percent)


def _grouped(pairs: list[Pair]) -> list[Pair]:
    """Give each pair the number of its group."""
    group_of: dict[str, list[str]] = {}
    for pair in pairs:
        one, two = (group_of.setdefault(code.name, [code.name]) for code in _both(pair))
        pair.is_nearest = one is not two
        if pair.is_nearest:
            one += two
            group_of.update(dict.fromkeys(two, one))
    groups = list({id(group): group for group in group_of.values()}.values())
    for pair in pairs:
        pair.group = 1 + groups.index(group_of[pair.first.name])
    return sorted(pairs, key=lambda pair: pair.group)


def _both(pair: Pair) -> tuple[Code, Code]:
    return pair.first, pair.second


def csv_text(pairs: list[Pair]) -> str:
    """Return one line for each pair."""
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerow(["group", "submission", "other", "alike", "lines"])
    for pair in pairs:
        names = [cell(code.name) for code in _both(pair)]
        lines = [f"{said(one)} = {', '.join(map(said, others))}" for one, others in pair.blocks]
        writer.writerow([pair.group, *names, f"{pair.percent}%: {LOOK}", cell(" | ".join(lines))])
    return file.getvalue()


def said(place: Place) -> str:
    file, first, last = place
    return f"{file}:{first}-{last}"


def text(pairs: list[Pair]) -> str:
    """Return one line for each group."""
    groups = itertools.groupby(pairs, key=lambda pair: pair.group)
    named = [sorted({code.name for pair in of_one for code in _both(pair)}) for _, of_one in groups]
    return console.plain("\n".join(f"alike: {LOOK}: {', '.join(names)}" for names in named))
