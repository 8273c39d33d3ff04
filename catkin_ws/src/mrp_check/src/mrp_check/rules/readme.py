# SPDX-License-Identifier: BSD-3-Clause
"""What a README says can be typed: its rosrun and roslaunch name what the package has."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part, line_of, nearest, perhaps
from mrp_check.sources import asked, uses

_COMMAND = re.compile(r"\b(rosrun|roslaunch)[ \t]+([A-Za-z]\w*)[ \t]+([A-Za-z][\w.-]*\w)(?![\w/<])")
_NAMES = re.compile(
    r"\b(rosservice (?:call|info|args)|rostopic (?:echo|hz|pub|info))[ \t]+(?:-\w+[ \t]+)*/?(\w+)\b"
)
_FILE = re.compile(r"(?i)^readme(\.\w+)?$")
_KIND = {"rosrun": "program", "roslaunch": "launch file"}
_ALIKE = 0.75


def _findings(case: Case) -> Iterator[Finding]:
    for file in case.package.files:
        if _FILE.match(last_part(file)):
            yield from _commands(case, file)
            yield from _names(case, file)


def _commands(case: Case, file: str) -> Iterator[Finding]:
    """Yield a Finding about each program and launch file that is not there."""
    package, model = case.package, case.model
    scripts = {last_part(path) for path in package.of_kind("python")}
    has = {
        "rosrun": {*model.executables(), *scripts},
        "roslaunch": {last_part(path) for path in package.of_kind("launch")},
    }
    for command in _COMMAND.finditer(package.text(file)):
        tool, owner, what = command.groups()
        known = has[tool] if model.complete or what.endswith((".py", ".launch")) else set()
        if owner == package.name and known and what not in known:
            near = nearest(what, known)
            said = f"this package has no such {_KIND[tool]}.{perhaps(near)}"
            yield _finding(file, command, "starts", said, what, near)
        elif owner != package.name and what in known and not uses.is_called_so(owner):
            said = f"the package is called {package.name}."
            yield _finding(file, command, "package-name", said, owner, package.name)


def _names(case: Case, file: str) -> Iterator[Finding]:
    """Yield a Finding about each name of a topic or service that is misspelt."""
    sources = [f for files in case.facts.sources.values() for f in files]
    offered = {one.base for one in asked.of(case.package, sources) if one.what == "offers"}
    ends = {
        last_part(place.text)
        for node in case.facts.sources
        for place in case.facts.of(node, Kind.PUBLISHER, Kind.SUBSCRIBER)
        if place.text
    }
    for command in _NAMES.finditer(case.package.text(file)):
        tool, name = command.groups()
        known = offered if tool.startswith("rosservice") else ends
        turned = {"_".join(sorted(one.split("_"))): one for one in known}
        near = turned.get("_".join(sorted(name.split("_")))) or nearest(name, known, _ALIKE)
        if near and near != name and name not in offered | ends:
            said = f"no node has that name.{perhaps(near)}"
            yield _finding(file, command, "topic", said, name, near)


def _finding(
    file: str, command: re.Match[str], id_: str, said: str, wrong: str, right: str | None
) -> Finding:
    return Finding(
        id_,
        f"{file} says '{command[0]}', and {said}",
        file,
        line_of(command),
        WARNING,
        expected=right or "what is in this package",
        seen=wrong,
        fix=f"Write {right} for {wrong}." if right else "Name what is there.",
    )


RULE = Rule(
    "static", 106, ("facts",), _findings, also=("package-name", "starts", "topic"), only=ANY
)
