# SPDX-License-Identifier: BSD-3-Clause
"""What the linker prints, as findings: a target, what it lacks, and plain words."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.contract.finding import Finding, Line
from mrp_check.package.cmake import Model, Target
from mrp_check.package.package import Package

_TARGET = re.compile(r"CMakeFiles/(?P<target>[^/]+)\.dir/")
_FAILED = re.compile(r"^make\S* \*\*\* \[.*?" + _TARGET.pattern, re.MULTILINE)


def findings(package: Package, output: str, model: Model) -> Iterator[Finding]:
    """Yield a finding for each target that cannot be linked."""
    reported, target = set(), None
    lines = output.splitlines()
    for number, line in enumerate(lines):
        named = _TARGET.search(line)
        if not named and _NO_MAIN.search(line):
            # Only what make says next names the target: another one may be built beside it.
            named = _FAILED.search("\n".join(lines[number:]))
        target = named.group("target") if named else target
        if target in reported or target not in model.targets:
            continue
        for shape, words in _WORDS:
            match = shape.search(line)
            if match:
                reported.add(target)
                yield words(package, model, model.targets[target], match)
                break


def _link(message: str, place: Line, expected: str, seen: str, fix: str, why: str) -> Finding:
    return Finding("link", message, *place, expected=expected, seen=seen, fix=fix, why=why)


def _no_main(package: Package, model: Model, target: Target, match: re.Match[str]) -> Finding:
    sources = ", ".join(target.sources)
    return _link(
        f"The target {target.name} has no function main: none of its sources ({sources}) defines"
        " one.",
        (target.file, target.line),
        "one source with int main(...)",
        sources,
        "Add the source that has main, or write main.",
        why="undefined-main",
    )


def _duplicate(package: Package, model: Model, target: Target, match: re.Match[str]) -> Finding:
    name = match.group("name")
    return _link(
        f"The target {target.name} has two definitions of {name}: two of its sources define it.",
        (target.file, target.line),
        f"one definition of {name}",
        ", ".join(target.sources),
        "Give each target only its own sources.",
        why="multiple-definition",
    )


def _no_library(package: Package, model: Model, target: Target, match: re.Match[str]) -> Finding:
    return _link(
        f"The target {target.name} is linked with {match.group(1)}, but there's no such library.",
        (target.file, target.link_line or target.line),
        "${catkin_LIBRARIES}",
        match.group(1),
        f"Correct the name {match.group(1)}.",
        why="cannot-find-library",
    )


def _undefined(package: Package, model: Model, target: Target, match: re.Match[str]) -> Finding:
    name = match.group("name")
    if "ros::" in name or name.startswith(("std_msgs::", "boost::", "typeinfo for ros")):
        return _of_ros(model, target, name)
    function = name.split("(")[0]
    simple = function.split("::")[-1]
    files = [file for file in target.sources if file in package.files]
    lines = ((file, package.find_line(file, f"{simple}(")) for file in files)
    used = next(((file, line) for file, line in lines if line), None)
    return _link(
        f"{name} is used in the target {target.name}, but none of its sources defines it.",
        used or (target.file, target.line),
        f"a definition of {function}",
        package.line(*used) if used else ", ".join(target.sources),
        f"Define {function}, or correct its name where it is defined; or add its source to"
        f" add_executable({target.name} ...).",
        why="undefined-reference",
    )


def _of_ros(model: Model, target: Target, name: str) -> Finding:
    linked = any("roscpp" in word for word in target.links)
    call = f"target_link_libraries({target.name} ${{catkin_LIBRARIES}})"
    if linked:
        why = "one of ROS's libraries is missing."
    elif target.link_line is not None and "roscpp" not in model.components:
        why = "find_package(catkin ...) doesn't name roscpp, so catkin_LIBRARIES lacks it."
    else:
        lacks = "is missing" if target.link_line is None else "has no ${catkin_LIBRARIES}"
        why = f"it isn't linked with ROS's libraries: {call.split('$')[0]}...) {lacks}."
    links = " ".join(target.links)[:200]
    return _link(
        f"The target {target.name} can't be linked: {name} isn't found, because {why}",
        (target.file, target.link_line or target.line),
        call,
        "no such call" if target.link_line is None else f"linked with: {links}",
        f"Add {call}.",
        why="undefined-reference",
    )


_NO_MAIN = re.compile(r"undefined reference to [`'‘]main['’]")
_WORDS = (
    (_NO_MAIN, _no_main),
    (
        re.compile(
            r"[\w./+-]+\.(?:cpp|cc|cxx|c\+\+|C)(?:\.o)?[:)].*?"
            r"undefined reference to [`'‘](?P<name>.+?)['’]$"
        ),
        _undefined,
    ),
    (re.compile(r"multiple definition of [`'‘](?P<name>.+?)['’]"), _duplicate),
    (re.compile(r"cannot find -l(\S+)"), _no_library),
)
