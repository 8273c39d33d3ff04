# SPDX-License-Identifier: BSD-3-Clause
"""Install rules, for a spec that asks for them."""

from __future__ import annotations

from typing import Iterator, Mapping

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.spec import Spec
from mrp_check.student.cmake import Model
from mrp_check.student.package import Package


def findings(
    package: Package,
    spec: Spec,
    model: Model,
    launch_file: str | None,
    started: Mapping[str, Started],
) -> Iterator[Finding]:
    """Yield a finding for each thing that is needed to run and is not installed."""
    words = {word for call in model.installs for word in call.arguments}
    wanted = [(name, target.line) for name, target in model.targets.items()]
    installed = {script.path for script in model.scripts}
    for name, line in wanted:
        if name not in words:
            yield _finding(f"the executable {name}", f"install(TARGETS {name} ...)", line)
    for path in started:
        if path not in installed:
            yield _finding(f"the script {path}", f"catkin_install_python(PROGRAMS {path} ...)", 1)
    if launch_file and not any(
        launch_file == word or launch_file.startswith(word.rstrip("/") + "/")
        for word in {
            word
            for call in model.installs
            for word in map(lambda w: model.path(w, call) or w, call.arguments)
        }
    ):
        yield _finding(f"the launch file {launch_file}", "install(DIRECTORY launch ...)", 1)


def _finding(what: str, expected: str, line: int) -> Finding:
    return Finding(
        "install",
        f"CMakeLists.txt does not install {what}: after catkin_make install, it is missing.",
        "CMakeLists.txt",
        line,
        expected=expected,
        seen="no install rule for it",
        fix=f"Add {expected}.",
    )


def _findings(case: Case) -> Iterator[Finding]:
    if case.spec.install:
        file = case.launch_file[0]
        yield from findings(case.package, case.spec, case.model, file, case.started)


RULE = Rule(
    stage="files",
    order=130,
    needs=("model", "launch"),
    findings=_findings,
    requirements={
        "install": Requirement("What is needed to run is installed", "building", evidence.cmake)
    },
)
