# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt has the calls that catkin needs."""

from __future__ import annotations

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence

FILE = "CMakeLists.txt"


def _missing():
    return Finding(
        "cmake",
        "The package has no CMakeLists.txt: catkin_make cannot build it.",
        expected="a file CMakeLists.txt beside package.xml",
        seen="none",
        fix="Write one, as the page on building shows.",
    )


def findings(package, model):
    """Yield findings about CMakeLists.txt, from a cmake.Model."""
    if model.project is None or model.catkin is None or model.catkin_package is None:
        for call, found, why in (
            ("project(NAME)", model.project, "CMake needs it first of all"),
            ("find_package(catkin REQUIRED ...)", model.catkin, "without it there is no catkin"),
            (
                "catkin_package()",
                model.catkin_package,
                "without it catkin does not know the package, and its executables are put where"
                " roslaunch and rosrun do not look",
            ),
        ):
            if found is None:
                before = model.catkin or (model.project and model.project[1])
                yield Finding(
                    "cmake",
                    f"CMakeLists.txt does not call {call}: {why}.",
                    FILE,
                    before.line if before else 1,
                    expected=call,
                    seen="no such call",
                    fix=f"Add {call} after this line." if before else f"Add {call}.",
                )
    if model.late is not None:
        yield Finding(
            "cmake",
            f"catkin_package() comes after the target {model.late.name} of line {model.late.line}:"
            " the executable is then put where roslaunch and rosrun do not look.",
            model.catkin_package.file,
            model.catkin_package.line,
            expected="catkin_package() before the first add_executable()",
            seen=f"{model.late.name} in line {model.late.line},"
            f" catkin_package() in line {model.catkin_package.line}",
            fix="Move catkin_package() up, to before the first target.",
        )


def _findings(case):
    there = FILE in case.package.files
    return findings(case.package, case.model) if there else [_missing()]


RULE = Rule(
    stage="files",
    order=40,
    needs=("model",),
    findings=_findings,
    requirements={
        "cmake": Requirement(
            "CMakeLists.txt is a catkin package's", "building#cmakelists-txt", evidence.always
        )
    },
)
