# SPDX-License-Identifier: BSD-3-Clause
"""Targets are made of files that are there, and what the calls of CMakeLists.txt name exists."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.names import last_part, nearest, perhaps
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.cmake import Command, Model, parsed
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

_MAIN = re.compile(r"\bint\s+main\s*\(")


def _findings(case: Case) -> Iterator[Finding]:
    yield from _no_sources(case)
    yield from _no_dependencies(case.package, case.model)
    if not case.spec.is_contract and case.model.complete:
        yield from _never_built(case)


def _no_sources(case: Case) -> Iterator[Finding]:
    for target in case.model.targets.values():
        for source, file, line in target.missing:
            near = nearest(source, case.package.of_kind("cpp"))
            yield Finding(
                "targets",
                f"The target {target.name} is built from {source}, but there's no such file."
                + perhaps(near),
                file,
                line,
                expected="the name of a file, relative to CMakeLists.txt",
                seen=source,
                fix=f"Write {near} for {source}." if near else "Name a file that exists.",
            )


def _missing(
    package: Package, call: Command, name: str, message: str, expected: str, fix: str
) -> Finding:
    line = call.line_of(package.lines(call.file), name)
    return Finding("targets", message, call.file, line, HABIT, expected, name, fix)


def _no_dependencies(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a warning for each target that is waited for, and that nothing makes. CMake says so
    only where cmake_minimum_required() names version 3.0 or later: then it stops."""
    for call in model.calls:
        for name in call.arguments[1:] if call.command == "add_dependencies" else ():
            if model.lacks_target(name):
                of_messages = "_generate_messages" in name and not model.generate
                near = None if of_messages else nearest(name, model.made)
                yield _missing(
                    package,
                    call,
                    name,
                    f"add_dependencies() makes {call.arguments[0]} wait for {name}, but there's no"
                    f" such target.{perhaps(near)}"
                    + (
                        " generate_messages() creates it, where it's called." if of_messages else ""
                    ),
                    f"a target {name}",
                    f"Write {near} for {name}." if near else f"Remove {name}.",
                )


def _never_built(case: Case) -> Iterator[Finding]:
    """Yield a warning for each program that no target is made of, and that no call names."""
    package, model = case.package, case.model
    built = {source for target in model.targets.values() for source in target.sources}
    files = [file for file in package.files if file.endswith(("CMakeLists.txt", ".cmake"))]
    calls = [call for file in files for call in parsed(package.text(file), file)]
    named = {last_part(word) for call in calls for word in call.arguments}
    for source in package.of_kind("cpp"):
        code = uses.code(package, source)
        is_node = bool(_MAIN.search(code)) and "ros::init" in code
        is_named = source in built or last_part(source) in named
        if is_node and not is_named and not uses.is_test(source):
            yield Finding(
                "targets",
                f"No call in CMakeLists.txt names {source}, so nothing is built from it.",
                source,
                1,
                HABIT,
                expected=f"add_executable(... {source})",
                seen="no target that's built from it",
                fix="Write add_executable() and target_link_libraries() for it; or delete it.",
            )


RULE = Rule(
    stage="files",
    needs=("model",),
    findings=_findings,
    requirements={
        "targets": Requirement(
            "Each executable is built from its own sources",
            "wrong#a-target-is-built-from-another-node-s-source",
            evidence.cpp,
        )
    },
)
