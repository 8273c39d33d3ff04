# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt has the calls that catkin needs."""

from __future__ import annotations

import ast
import posixpath
import re
from typing import Iterator

from mrp_check import releases
from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import line_of
from mrp_check.package.cmake import Model
from mrp_check.package.package import Package

FILE = "CMakeLists.txt"
_ROUND = re.compile(
    r"^[^#\n]*\$\(((?:CATKIN|CMAKE|PROJECT|catkin)_\w+|PROJECT_NAME)\)", re.MULTILINE
)
_MAKES = ("add_executable", "add_library")
_USES_FOUND = ("include_directories", "target_include_directories", "target_link_libraries")
# Commands that are called once, and what a second call does.
_ONCE = {
    "project": "a second CMakeLists.txt may have been pasted below the first",
    "catkin_package": "what it says replaces all that the first one said",
}
_LOST = ", and its executables are put where roslaunch and rosrun do not look"


def _findings(case: Case) -> Iterator[Finding]:
    yield from python_setup(case)
    if FILE in case.package.files:
        yield from _missing_calls(case.package, case.model)
        yield from _too_late(case.model)
        yield from _no_folder(case.package, case.model)
        yield from _in_round_brackets(case.package)
        yield from _twice(case.model)
        if not case.spec.is_contract:
            yield from _old(case.package, case.model)
            yield from _boost_system(case.package, case.model)
            yield from _again(case.package, case.model)
            yield from _made_again(case.package, case.model)
    else:
        yield Finding(
            "cmake",
            "The package has no CMakeLists.txt: catkin_make cannot build it.",
            expected="a file CMakeLists.txt beside package.xml",
            seen="none",
            fix="Write one, as the page on building shows.",
        )


def _in_round_brackets(package: Package) -> Iterator[Finding]:
    """https://cmake.org/cmake/help/latest/manual/cmake-language.7.html#variable-references"""
    for match in _ROUND.finditer(package.text(FILE)):
        name, line = match[1], line_of(match, 1)
        yield Finding(
            "cmake",
            f"CMake reads $({name}) as a text: a variable stands in braces.",
            FILE,
            line,
            HABIT,
            expected=f"${{{name}}}",
            seen=package.line(FILE, line),
            fix=f"Write ${{{name}}}.",
            change=(f"$({name})", f"${{{name}}}"),
        )


def _old(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding if CMakeLists.txt is written for a CMake that is too old for CMake 4: a
    warning where this machine's CMake warns, too. Of MIN...MAX, MAX counts.
    https://cmake.org/cmake/help/latest/command/cmake_minimum_required.html
    """
    asked = next((one for one in model.calls if one.command == "cmake_minimum_required"), None)
    newest = asked.arguments[1].split("...")[-1] if asked and asked.arguments[1:] else ""
    numbers = tuple(map(int, re.findall(r"\d+", newest)))
    if asked and numbers and numbers < releases.CMAKE_LEAST:
        gone = releases.GONE["cmake"]
        warned = (3, 10) if (releases.here() or 0) >= 13 else (2, 8, 12)
        least = ".".join(map(str, releases.CMAKE_LEAST))
        yield Finding(
            "cmake",
            f"This is written for CMake {newest}. A newer CMake warns of it, and CMake 4"
            f" (Debian {gone.since}) refuses all below {least}.",
            FILE,
            asked.line,
            HABIT if numbers < warned else HINT,
            expected=gone.instead,
            seen=package.line(FILE, asked.line),
            fix=f"Write {gone.instead}.",
            why=gone.why,
        )


def _boost_system(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a note if the library boost_system is linked: where it is gone, the linker says so."""
    gone = releases.GONE["boost_system"]
    for call in model.calls:
        if call.command == "target_link_libraries":
            # What ${catkin_LIBRARIES} brings along is catkin's own.
            is_own = "boost_system" in package.text(call.file)
            if is_own and {"boost_system", "-lboost_system"} & {*call.arguments}:
                yield Finding(
                    "cmake",
                    f"From Debian {gone.since} on, there is no {gone.what}.",
                    call.file,
                    call.line,
                    HINT,
                    expected=gone.instead,
                    seen=package.line(call.file, call.line),
                    fix="Take boost_system out.",
                    why=gone.why,
                )


def _twice(model: Model) -> Iterator[Finding]:
    """Yield a warning if catkin is found again: what the first call alone names is forgotten."""
    finds = [call for call in model.calls if call.command == "find_package"]
    finds = [call for call in finds if call.arguments[:1] == ["catkin"]]
    for first, call in [(finds[0], finds[-1])] if finds[1:] else []:
        rest = model.calls[model.calls.index(call) :]
        lost = sorted({*first.arguments} - {*call.arguments, "REQUIRED", "COMPONENTS"})
        if lost and any(later.command in _USES_FOUND for later in rest):
            yield Finding(
                "cmake",
                f"find_package(catkin ...) is called again, after line {first.line}:"
                f" catkin_LIBRARIES has nothing of {', '.join(lost)} any more.",
                call.file,
                call.line,
                HABIT,
                expected="one call, which names all",
                seen=f"find_package({' '.join(call.arguments)})",
                fix=f"Write all of it into line {first.line}, and take this one out.",
            )


def _again(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a warning for each call that does over again what an earlier one did."""
    if not model.complete and any(call.command == "if" for call in model.calls):
        return  # CMake makes one of the two
    for command, why in _ONCE.items():
        calls = [one for one in model.calls if (one.command, one.file) == (command, FILE)]
        for call in [one for one in calls[1:] if one.line != calls[0].line]:
            yield Finding(
                "cmake",
                f"{command}() is called again, after line {calls[0].line}: {why}.",
                FILE,
                call.line,
                HABIT,
                expected="one call",
                seen=package.line(FILE, call.line),
                fix=f"Write all of it into line {calls[0].line}, and take this one out.",
            )


def _made_again(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding for each target that is made a second time. CMake says so where it comes to
    that line."""
    made: dict[str, int] = {}
    if model.complete or any(call.command == "if" for call in model.calls):
        return
    for call in model.calls:
        name = call.arguments[0] if call.command in _MAKES and call.arguments else "$"
        first = made.setdefault(name, call.line)
        if "$" not in name and call.file == FILE and call.line != first:
            yield Finding(
                "cmake",
                f"{call.command}() makes the target {name} again, after line {first}: CMake stops.",
                FILE,
                call.line,
                expected=f"one target {name}",
                seen=package.line(FILE, call.line),
                fix=f"Take this call out, or that in line {first}.",
            )


def _missing_calls(package: Package, model: Model) -> Iterator[Finding]:
    before = model.catkin or (model.project and model.project[1])
    for needed, found, why in (
        ("project(NAME)", model.project, "CMake needs it first of all"),
        ("find_package(catkin REQUIRED ...)", model.catkin, "without it there is no catkin"),
        (
            "catkin_package()",
            model.catkin_package or _is_included(package, model),
            "without it no other package finds this one"
            # add_message_files() says where executables are put, too.
            + ("" if model.add_message_files else _LOST),
        ),
    ):
        if not found:
            is_package = needed.startswith("catkin_package")
            before = model.generate or before if is_package else before
            commented = is_package and package.first_match([FILE], r"^\s*#\s?catkin_package\(")
            yield Finding(
                "cmake",
                f"CMakeLists.txt does not call {needed}: {why}.",
                FILE,
                commented[1] if commented else before.line if before else 1,
                expected=needed,
                seen="no such call",
                fix=f"Add {needed} after this line." if before else f"Add {needed}.",
                certainty=HABIT if is_package and model.add_message_files else CERTAIN,
            )


def _is_included(package: Package, model: Model) -> bool:
    """Return whether a file that CMake did not come to may call catkin_package()."""
    files = [path for path in package.files if path.endswith(".cmake")]
    return not model.complete and any("catkin_package" in package.text(file) for file in files)


def _too_late(model: Model) -> Iterator[Finding]:
    call = model.catkin_package
    if model.late is not None and call is not None:
        yield Finding(
            "cmake",
            f"catkin_package() comes after the target {model.late.name} of line {model.late.line}:"
            " the executable is then put where roslaunch and rosrun do not look.",
            call.file,
            call.line,
            expected="catkin_package() before the first add_executable()",
            seen=f"{model.late.name} in line {model.late.line},"
            f" catkin_package() in line {call.line}",
            fix="Move catkin_package() up, to before the first target.",
        )


def _no_folder(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding for each folder that catkin_package() passes on, and that is not there."""
    for name in model.include_dirs:
        if model.catkin_package and not name.startswith(("/", "$")):
            if not (package.root / name).is_dir():
                yield Finding(
                    "cmake",
                    f"catkin_package() names the folder {name} in INCLUDE_DIRS, and there is no"
                    " such folder: CMake stops.",
                    model.catkin_package.file,
                    model.catkin_package.line_of(package.lines(model.catkin_package.file), name),
                    expected="a folder of the package",
                    seen=f"INCLUDE_DIRS {name}",
                    fix=f"Take INCLUDE_DIRS {name} out; or make the folder, with a file in it, as"
                    " git keeps no empty folder.",
                )


SETUP = "setup.py"


def python_setup(case: Case) -> Iterator[Finding]:
    package = case.package
    is_used = any(call.command == "catkin_python_setup" for call in case.model.calls)
    if is_used and SETUP in package.files:
        yield from _old_setup(package)
        yield from _no_python_folder(package)


def _old_setup(package: Package) -> Iterator[Finding]:
    """https://wiki.ros.org/noetic/Migration#Setuptools_instead_of_Distutils"""
    place = package.first_match([SETUP], r"^\s*(?:from|import)\s+distutils\b")
    if place:
        yield Finding(
            "cmake",
            f"{SETUP} imports distutils, which Python has not any more from 3.12 on.",
            *place,
            HABIT,
            expected="from setuptools import setup",
            seen=package.line(*place),
            fix="Take setup from setuptools; package.xml then needs"
            " <buildtool_depend>python3-setuptools</buildtool_depend>.",
        )


def _no_python_folder(package: Package) -> Iterator[Finding]:
    """Yield a finding for each: catkin_make takes it, and `catkin_make install` fails."""
    given = {
        keyword.arg: _plain(keyword.value)
        for call in ast.walk(package.tree(SETUP))
        if isinstance(call, ast.Call)
        for keyword in call.keywords
    }
    names, folders = given.get("packages"), given.get("package_dir") or {}
    if not isinstance(names, list) or not isinstance(folders, dict):
        return
    for name in filter(lambda one: isinstance(one, str), names):
        folder = folders.get(name) or posixpath.join(folders.get("", ""), name.replace(".", "/"))
        if not (package.root / folder).is_dir():
            line = package.find_line(SETUP, name, 1)
            yield Finding(
                "cmake",
                f"{SETUP} names the Python package {name}, and there is no folder {folder}:"
                " `catkin_make install` fails.",
                SETUP,
                line,
                HABIT,
                expected=f"a folder {folder} with a file __init__.py",
                seen=package.line(SETUP, line),
                fix=f"Make the folder; or take {SETUP} and catkin_python_setup() away.",
            )


def _plain(node: ast.expr) -> object:
    try:
        return ast.literal_eval(node)
    except ValueError:
        return None


RULE = Rule(
    stage="files",
    needs=("model",),
    findings=_findings,
    requirements={
        "cmake": Requirement(
            "CMakeLists.txt is a catkin package's", "building#cmakelists-txt", evidence.always
        )
    },
)
