# SPDX-License-Identifier: BSD-3-Clause
"""What g++ prints, as findings: the first error of each source, and its line."""

from __future__ import annotations

import os
import pathlib
import re
from typing import Iterator

from mrp_check.build import cpp_words
from mrp_check.build.cpp_words import Problem
from mrp_check.code import uses
from mrp_check.contract.finding import HABIT, Finding, Line
from mrp_check.package.cmake import relative
from mrp_check.package.package import Package

_ERROR = re.compile(
    r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):(?:\d+:)? (?:fatal )?error: (?P<text>.*)$"
)
_NO_RETURN = re.compile(
    r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):(?:\d+:)? warning: no return statement in function"
)
_WARNING = re.compile(
    r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):\d+: warning: (?P<text>.*) \[-W(?P<name>[\w-]+)=?\]$"
)
# What g++ is called with, where a package wants no warnings of its own.
DOUBTING = "-Wall -Wduplicated-cond -Wempty-body -Wformat-security -Wtype-limits"
_FROM = re.compile(r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):\d+:\s+required from")
_INCLUDED = re.compile(r"^(?:In file included from| +from) (?P<file>[^:]+):(?P<line>\d+)")

# An error that no other one follows from: the name is right but for its last part.
_ALONE = re.compile(r"has no member named")
# An error about a name: others follow from it only where they name what its line declares.
_NAMED = re.compile(
    r"[‘'](?P<name>\w+)[^’']*[’'] (?:was not declared|is not a member|has not been declared)"
    r"|has no member named [‘'](?P<member>\w+)"
)


def problems(output: str, copy: pathlib.Path) -> list[Problem]:
    """Return, for each source of the package, the first error that the compiler found in it, the
    next one behind each that no other follows from, and those about other names."""
    lines = output.splitlines()
    found: list[Problem] = []
    chain: list[Line | None] = []  # of "required from"; None for a place in a header of others
    included: list[Line | None] = []
    for index, line in enumerate(lines):
        inclusion = _INCLUDED.match(line)
        if inclusion:
            if line.startswith("In file"):
                included, chain = [], []
            included.append(_place(inclusion, copy))
            continue
        required = _FROM.match(line)
        if required:
            chain.append(_place(required, copy))
            continue
        error = _ERROR.match(line)
        if not error:
            if line.startswith("[") or "In function" in line or "At global scope" in line:
                chain, included = [], []
            continue
        after = "\n".join(lines[index + 1 : index + 40])
        # An error in a header of ROS's was caused where the package uses it: the last place of
        # "required from" that is the package's own.
        own = _place(error, copy)
        if own is None:
            places = [place for place in chain if place] or [p for p in included if p]
            later = [_place(m, copy) for m in map(_FROM.match, lines[index + 1 : index + 12]) if m]
            places += [place for place in later if place]
            own = (places[-1] if chain else places[0]) if places else None
        chain, included = [], []
        if own is not None:
            found.append(Problem(*own, error.group("text"), after))
    return _first(found, copy)


def _first(found: list[Problem], copy: pathlib.Path) -> list[Problem]:
    first: dict[str, list[Problem]] = {}
    for problem in found:
        of_file = first.setdefault(problem.file, [])
        lines = {earlier.line for earlier in of_file}
        is_alone = all(map(_ALONE.search, (earlier.text for earlier in of_file)))
        if problem.line not in lines and (is_alone or _is_other(problem, of_file, copy)):
            of_file.append(problem)
    return [problem for of_file in first.values() for problem in of_file]


def _is_other(problem: Problem, before: list[Problem], copy: pathlib.Path) -> bool:
    """Return whether an error about a name follows from none of those before, all about names."""
    named = _NAMED.search(problem.text)
    if not named or not all(_NAMED.search(earlier.text) for earlier in before):
        return False
    lines = (copy / problem.file).read_text(errors="replace").splitlines()
    # What a line before was to declare, or names as well, is missing because of it.
    text = " ".join(lines[earlier.line - 1] for earlier in before if 0 < earlier.line <= len(lines))
    return not re.search(rf"\b{named['name'] or named['member']}\b", text)


def is_no_header(problem: Problem) -> re.Match[str] | None:
    """Return the match of the header that is not there, if that is what the compiler stops at."""
    return re.match(r"(\S+): No such file or directory", problem.text)


def absent(package: Package, problems: list[Problem]) -> dict[str, str]:
    """Return file -> the package that has the header it stops at, and is not on this machine."""
    found = {}
    for problem in problems:
        header = is_no_header(problem)
        name = header and uses.absent_header(package, header[1])
        if name:
            found[problem.file] = name
    return found


def without_return(package: Package, output: str, copy: pathlib.Path) -> list[Finding]:
    """Return a Finding for each function that says it returns a value, and never does: g++ warns of
    it, and takes it. Such a function may return anything, or nowhere (C++17, 9.6.3)."""
    matches = map(_NO_RETURN.match, output.splitlines())
    places = dict.fromkeys(_place(match, copy) for match in matches if match)
    return [
        Finding(
            "compile",
            f"The function that ends on line {line} of {file} says that it returns a value, but has"
            " no return: its caller gets an arbitrary value, and the node may crash.",
            file,
            line,
            expected="return, with a value",
            seen=package.line(file, line),
            fix="Return a value there: true, in the callback of a service that did its work.",
        )
        for file, line in filter(None, places)
    ]


def warnings(output: str, copy: pathlib.Path) -> Iterator[tuple[str, int, str, str]]:
    """Yield (file, line, name of the warning, what g++ says) of the package's own lines."""
    for match in filter(None, map(_WARNING.match, output.splitlines())):
        place = _place(match, copy)
        if place:
            yield (*place, match["name"], match["text"])


def _place(match: re.Match[str], copy: pathlib.Path) -> Line | None:
    # ccache hands the compiler paths that are relative to where it runs.
    path = os.path.join(copy.parents[1] / "build" / copy.name, match.group("file"))
    file = relative(path, copy)
    return (file, int(match.group("line"))) if file else None


def finding(package: Package, problem: Problem) -> Finding:
    """Return the Finding about a Problem."""
    lines = package.lines(problem.file)
    standard = _STANDARD.search(problem.text)
    if standard:
        return _old_standard(package, standard.group(1), problem)
    words = cpp_words.of(package, problem)
    header = None if words.change else is_no_header(problem)
    line = words.line or max(1, min(problem.line, len(lines)))
    return Finding(
        "compile",
        f"The compiler stops at line {line} of {problem.file}: {words.said}",
        problem.file,
        line,
        expected="C++ that the compiler accepts",
        seen=f"{lines[line - 1].strip()}  (g++: {problem.text})",
        fix=words.fix,
        change=words.change,
        why=words.why,
        packages=(uses.package_of_header(header[1]),) if header else (),
    )


_STANDARD = re.compile(r"support for the ISO C\+\+ (?:20)?(\d+) standard")
_OLD = r"^[^#]*(?:-std=(?:c|gnu)\+\+(?:0x|11|14)\b|CMAKE_CXX_STANDARD\s+(?:11|14)\b)"


def older_standard(package: Package, output: str) -> Iterator[Finding]:
    """Yield a warning about a standard of C++ that the compiler takes here, and does not where ROS
    has a newer log4cxx."""
    place = None if _STANDARD.search(output) else package.first_match(["CMakeLists.txt"], _OLD)
    if place and package.of_kind("cpp"):
        yield Finding(
            "compile",
            "CMakeLists.txt selects a C++ standard older than C++17: it works here, but ROS's"
            " headers don't compile with it where log4cxx is newer.",
            *place,
            HABIT,
            expected="no such line, because the compiler uses C++17 by default",
            seen=package.line(*place),
            fix="Remove the line, or set the standard to 17.",
        )


def _old_standard(package: Package, needed: str, problem: Problem) -> Finding:
    """Return the Finding about a standard of C++ that is too old, as CMakeLists.txt sets it."""
    file = "CMakeLists.txt"
    line = package.find_line(file, "CXX_STANDARD") or package.find_line(file, "-std=") or 1
    return Finding(
        "compile",
        f"CMakeLists.txt selects a C++ standard older than C++{needed}, which the"
        " code or ROS's headers need.",
        file,
        line,
        expected="set(CMAKE_CXX_STANDARD 17), or no such line",
        seen=f"{package.line(file, line)}  (g++: {problem.text})",
        fix="Set the standard to 17.",
        why="old-standard",
    )
