# SPDX-License-Identifier: BSD-3-Clause
"""Each source compiles, and each target can be linked."""

from __future__ import annotations

from typing import Iterator

from mrp_check import evidence
from mrp_check.building import compiler, configuring, linker
from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule


def findings(case: Case) -> Iterator[Finding]:
    if not case.built:
        return
    output, package = case.built.output, case.package
    yield from compiler.without_return(package, output, case.package_folder)
    if case.built.ok:
        return
    problems = compiler.problems(output, case.package_folder)
    found = [compiler.finding(package, problem) for problem in problems]
    found += linker.findings(package, output, case.model)
    yield from found or [configuring.unknown(package, case.built, "compile")]


RULE = Rule(
    stage="build",
    order=20,
    needs=("built",),
    findings=findings,
    requirements={
        "compile": Requirement("The C++ code compiles", "building#catkin-make", evidence.compiled),
        "link": Requirement("The executables can be linked", "building", evidence.built),
    },
)
