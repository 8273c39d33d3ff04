# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt has the calls that catkin needs."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check import releases
from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.cmake import Model
from mrp_check.package.manifest import of_ros_2
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

FILE = "CMakeLists.txt"
_LOST = ", so its executables end up where roslaunch and rosrun don't look"


def _findings(case: Case) -> Iterator[Finding]:
    if of_ros_2(case.manifest[0]):
        return
    if FILE in case.package.files:
        yield from _missing_calls(case.package, case.model)
        yield from _too_late(case.model)
        yield from _no_folder(case.package, case.model)
        if not case.spec.is_contract:
            yield from _old(case.package, case.model)
    else:
        yield Finding(
            "cmake",
            "The package has no CMakeLists.txt, so catkin_make can't build it.",
            expected="a file CMakeLists.txt next to package.xml",
            seen="none",
            fix="Write one, as the page on building shows.",
        )


def _old(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding if CMakeLists.txt is written for a CMake that is too old for CMake 4: a
    warning where this machine's CMake warns, too. Of MIN...MAX, MAX counts.
    https://cmake.org/cmake/help/latest/command/cmake_minimum_required.html
    """
    asked = next((call for call in model.calls if call.command == "cmake_minimum_required"), None)
    newest = asked.arguments[1].split("...")[-1] if asked and asked.arguments[1:] else ""
    numbers = tuple(map(int, re.findall(r"\d+", newest)))
    if asked and numbers and numbers < releases.CMAKE_LEAST:
        gone = releases.GONE["cmake"]
        warned = (3, 10) if (releases.here() or 0) >= 13 else (2, 8, 12)
        least = ".".join(map(str, releases.CMAKE_LEAST))
        yield Finding(
            "cmake",
            f"This is written for CMake {newest}. A newer CMake warns about it, and CMake 4"
            f" (Debian {gone.since}) refuses anything below {least}.",
            FILE,
            asked.line,
            HABIT if numbers < warned else HINT,
            expected=gone.instead,
            seen=package.line(FILE, asked.line),
            fix=f"Write {gone.instead}.",
            why=gone.why,
        )


def _missing_calls(package: Package, model: Model) -> Iterator[Finding]:
    before = model.catkin or (model.project and model.project[1])
    for needed, found, why in (
        ("project(NAME)", model.project, "CMake needs it first of all"),
        ("find_package(catkin REQUIRED ...)", model.catkin, "without it there's no catkin"),
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
                f"CMakeLists.txt doesn't call {needed}: {why}.",
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
            f"catkin_package() comes after the target {model.late.name} on line {model.late.line},"
            " so the executable ends up where roslaunch and rosrun don't look.",
            call.file,
            call.line,
            expected="catkin_package() before the first add_executable()",
            seen=f"{model.late.name} on line {model.late.line}, catkin_package() on line"
            f" {call.line}",
            fix="Move catkin_package() up, to before the first target.",
        )


def _no_folder(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding for each folder that catkin_package() passes on, and that is not there."""
    for name in model.include_dirs:
        if model.catkin_package and not name.startswith(("/", "$")):
            if not (package.root / name).is_dir():
                yield Finding(
                    "cmake",
                    f"catkin_package() names the folder {name} in INCLUDE_DIRS, but there's no"
                    " such folder, so CMake stops.",
                    model.catkin_package.file,
                    model.catkin_package.line_of(package.lines(model.catkin_package.file), name),
                    expected="a folder of the package",
                    seen=f"INCLUDE_DIRS {name}",
                    fix=f"Remove INCLUDE_DIRS {name}; or create the folder with a file in it,"
                    " because Git doesn't keep empty folders.",
                )


RULE = Rule(
    stage="files",
    needs=("manifest", "model"),
    findings=_findings,
    requirements={
        "cmake": Requirement(
            "CMakeLists.txt calls what catkin needs", "building#cmakelists-txt", evidence.always
        )
    },
)
