# SPDX-License-Identifier: BSD-3-Clause
"""No source, launch file or file of parameters names a path in the home folder of its author."""

from __future__ import annotations

import re
from typing import Iterable, Iterator

from mrp_check.code import uses
from mrp_check.confined.places import HOME, Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.names import line_of
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case

_PARAMETERS = (".yaml", ".yml", ".ini")
_COMMENT = re.compile(r"(?m)(?:^|[ \t])#.*$")


def _findings(case: Case) -> Iterator[Finding]:
    package, facts = case.package, case.facts
    in_code: dict[str, list[tuple[str, int]]] = {}
    for place in facts.places:
        is_part = place.file in facts.relevant or place.file not in facts.python
        if place.kind is Kind.PATH and is_part:
            in_code.setdefault(place.file, []).append((place.text or "", place.line))
    for file, found in in_code.items():
        yield from _first_of_each(file, found)
    for file in package.of_kind("launch"):
        yield from _first_of_each(file, _in_text(uses.code(package, file)))
    for file in (path for path in package.files if path.endswith(_PARAMETERS)):
        yield from _first_of_each(file, _in_text(_COMMENT.sub("", package.text(file))))


def _first_of_each(file: str, found: Iterable[tuple[str, int]]) -> Iterator[Finding]:
    named: set[str] = set()
    for path, line in found:
        if path not in named:
            named.add(path)
            yield Finding(
                "starts",
                f"{file} names {path}, a path in somebody's home folder: no other computer has"
                " that file.",
                file,
                line,
                HABIT,
                expected="a path that is found from the package's folder: $(find PACKAGE) in a"
                " launch file, rospkg in Python, ros::package::getPath() in C++; or a parameter",
                seen=path,
                fix="Put the file into the package, and start the path from the package's folder.",
            )


def _in_text(text: str) -> Iterator[tuple[str, int]]:
    for match in HOME.finditer(text):
        yield match.group(), line_of(match)


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
