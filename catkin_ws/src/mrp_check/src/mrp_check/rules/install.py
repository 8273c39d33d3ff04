# SPDX-License-Identifier: BSD-3-Clause
"""What is needed to run is installed: for a spec that asks for it; without a contract it is a note,
as `catkin_make` runs it from where it is."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import ERROR, NOTE, WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running.words import few
from mrp_check.sources.uses import is_test
from mrp_check.student.cmake import sections

_OF_FILES = ("DIRECTORY", "FILES", "PROGRAMS")


def _findings(case: Case) -> Iterator[Finding]:
    """Yield a finding for each thing that is needed to run and is not installed."""
    if not case.spec.is_contract:
        yield from _notes(case)
        yield from _gone(case)
    if not case.spec.install:
        return
    model, (launch_file, _) = case.model, case.launch_file
    words = [(call, word) for call in model.installs for word in call.arguments]
    for name, target in model.targets.items():
        if name not in {word for _, word in words}:
            yield _finding(f"the executable {name}", f"install(TARGETS {name} ...)", target.line)
    installed = {script.path for script in model.scripts}
    for path in (path for path in case.started if path not in installed):
        yield _finding(f"the script {path}", f"catkin_install_python(PROGRAMS {path} ...)", 1)
    paths = {model.path(word, call) or word for call, word in words}
    if launch_file and not any(f"{launch_file}/".startswith(f"{p.rstrip('/')}/") for p in paths):
        yield _finding(f"the launch file {launch_file}", "install(DIRECTORY launch ...)", 1)


def _notes(case: Case) -> Iterator[Finding]:
    """Yield a note for the executables, one for the scripts and one for the launch files that are
    not installed, as far as CMakeLists.txt says it plainly."""
    package, model = case.package, case.model
    words = {word for call in model.installs for word in call.arguments}
    if any("$" in word or "*" in word for word in words):
        return
    targets = [target for target in model.executables().values() if target.name not in words]
    scripts = {script.path for script in model.scripts}
    folders = {word.rstrip("/") for word in words}
    nodes = [node.file for node in case.spec.nodes.values() if node.file]
    left = [one for one in nodes if one not in scripts and one.partition("/")[0] not in folders]
    files = [one for one in package.of_kind("launch") if one not in words and not is_test(one)]
    launch = [one for one in files if one.partition("/")[0] not in folders]
    line = model.catkin_package.line if model.catkin_package else 1
    if targets:
        names = ", ".join(target.name for target in targets)
        yield _finding(names, f"install(TARGETS {names} ...)", targets[0].line, NOTE)
    if left:
        yield _finding(few(left), f"catkin_install_python(PROGRAMS {left[0]} ...)", line, NOTE)
    if launch:
        yield _finding(few(launch), "install(DIRECTORY launch ...)", line, NOTE)


def _gone(case: Case) -> Iterator[Finding]:
    """Yield a warning for each file or folder that install() names and that is not there.

    https://cmake.org/cmake/help/latest/command/install.html
    """
    calls = (call for call in case.model.installs if call.command == "install")
    for call in (one for one in calls if "OPTIONAL" not in one.arguments):
        parts = sections(call.arguments, list(filter(str.isupper, call.arguments)))
        words = [word for kind in _OF_FILES for word in parts.get(kind, [])]
        for word in (one for one in words if not re.search("[$*<]", one)):
            path = case.model.path(word, call)
            if path and not (case.package.root / path).exists():
                yield Finding(
                    "install",
                    f"install() names {word}, and there is no such file or folder: catkin_make"
                    " install stops.",
                    call.file,
                    call.line,
                    WARNING,
                    expected="files and folders that are there",
                    seen=word,
                    fix=f"Take {word} out; or make it.",
                )


def _finding(what: str, expected: str, line: int, severity: str = ERROR) -> Finding:
    return Finding(
        "install",
        f"CMakeLists.txt does not install {what}: after catkin_make install, it is missing.",
        "CMakeLists.txt",
        line,
        severity,
        expected=expected,
        seen="no install rule for it",
        fix=f"Add {expected}.",
    )


RULE = Rule(
    stage="files",
    order=130,
    needs=("model", "launch"),
    findings=_findings,
    requirements={
        "install": Requirement("What is needed to run is installed", "building", evidence.cmake)
    },
)
