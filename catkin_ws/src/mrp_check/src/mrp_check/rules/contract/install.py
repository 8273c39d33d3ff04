# SPDX-License-Identifier: BSD-3-Clause
"""Everything that's needed to run is installed, if the contract asks for it."""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    """Yield a finding for each thing that is needed to run and is not installed."""
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


def _finding(what: str, expected: str, line: int) -> Finding:
    return Finding(
        "install",
        f"CMakeLists.txt doesn't install {what}: after catkin_make install, it's missing.",
        "CMakeLists.txt",
        line,
        expected=expected,
        seen="no install rule for it",
        fix=f"Add {expected}.",
    )


RULE = Rule(
    stage="files",
    needs=("model", "launch"),
    findings=_findings,
    requirements={
        "install": Requirement(
            "Everything that's needed to run is installed", "building", evidence.cmake
        )
    },
    only=CONTRACT,
)
