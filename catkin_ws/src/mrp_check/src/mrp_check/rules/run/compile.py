# SPDX-License-Identifier: BSD-3-Clause
"""Each source compiles, and each target can be linked."""

from __future__ import annotations

import os
import re
from typing import Iterator

from mrp_check.build import compiler, configuring, linker
from mrp_check.code import uses
from mrp_check.contract.errors import CannotCheck, NotHere
from mrp_check.contract.finding import Finding
from mrp_check.contract.names import printable
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.case import Case

# What make says of a target that it couldn't make, with the folder of its package.
_FAILED = re.compile(r"\*\*\* \[(?:CMakeFiles/Makefile2:\d+: )?([^/\s]+)/CMakeFiles/")


def findings(case: Case) -> Iterator[Finding]:
    if not case.built:
        yield from _of_other_machines(case)
        yield from () if case.spec.is_contract else compiler.older_standard(case.package, "")
        return
    output, package = case.built.output, case.package
    yield from compiler.without_return(package, output, case.package_folder)
    if not case.spec.is_contract:
        yield from compiler.older_standard(package, output)
    if case.built.ok:
        return
    problems = compiler.problems(output, case.package_folder)
    absent = {} if case.spec.is_contract else compiler.absent(package, problems)
    found = [compiler.finding(package, p) for p in problems if p.file not in absent]
    found += linker.findings(package, output, case.model)
    if not found and not absent:
        if others := _failed_siblings(case):
            raise CannotCheck(f"It's built with {' and '.join(others)}, which can't be built here.")
        found = [configuring.unknown(package, case.built, "compile")]
    yield from found
    if absent:
        raise NotHere(uses.absent(name, "cpp") for name in sorted({*absent.values()}))


def _failed_siblings(case: Case) -> list[str]:
    """Return the names of the packages that make names as failed; none if it names this one."""
    failed = {*_FAILED.findall(case.built.output if case.built else "")}
    folders = {printable(other.root.resolve().name): other.name for other in case.package.siblings}
    return [folders[folder] for folder in sorted(failed)] if failed <= {*folders} else []


def _of_other_machines(case: Case) -> Iterator[Finding]:
    """Yield a finding for each header that a source includes by a whole path, and that isn't there.
    It takes no compiler to say so: nothing is compiled where CMake could not go on."""
    package = case.package
    built = {file for target in case.model.targets.values() for file in target.sources}
    for file in sorted(built & {*package.files}):
        for header, line in uses.includes(package, file):
            if os.path.isabs(header) and not os.path.exists(header):
                yield Finding(
                    "compile",
                    f"{file} includes {header}, by its full path on somebody's computer: there's"
                    " no such file here.",
                    file,
                    line,
                    expected="a path that begins with the name of a package",
                    seen=package.line(file, line),
                    fix="Write only the names of the package and the header.",
                    packages=(uses.package_of_header(header),),
                )


RULE = Rule(
    stage="build",
    needs=("built",),
    findings=findings,
    requirements={
        "compile": Requirement("The C++ code compiles", "building#catkin-make", evidence.compiled),
        "link": Requirement("The executables can be linked", "building", evidence.built),
    },
)
