# SPDX-License-Identifier: BSD-3-Clause
"""The package's name, which stands in package.xml, in CMakeLists.txt and in the launch file."""

from __future__ import annotations

import collections
import re
from typing import Iterator

from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

# https://www.ros.org/reps/rep-0144.html
_USUAL = re.compile(r"[a-z][a-z0-9_-]*")


def _findings(case: Case) -> Iterator[Finding]:
    """Yield a finding if package.xml and CMakeLists.txt disagree; the others say who is right."""
    package, launch = case.package, case.launch
    if not case.spec.is_contract:
        yield from _unusual(package)
    if case.manifest[0] is None or case.model.project is None:
        return
    project, call = case.model.project
    if project == package.name or "$" in project:
        return
    votes = collections.Counter([package.root.resolve().name])
    votes.update(node.package for node in (launch.nodes if launch else []))
    if votes[project] > votes[package.name]:
        file, line, wrong, right = "package.xml", None, package.name, project
        line = package.find_line(file, f">{package.name}<") or package.find_line(file, "<name", 1)
        expected, seen = f"<name>{right}</name>", f"<name>{wrong}</name>"
    else:
        file, line, wrong, right = call.file, call.line, project, package.name
        expected, seen = f"project({right})", f"project({wrong})"
    other = "CMakeLists.txt calls" if file == "package.xml" else "package.xml calls"
    yield Finding(
        "package-name",
        f"{file} calls the package {wrong}, but {other} it {right}, so catkin can't build it.",
        file,
        line,
        expected=expected,
        seen=seen,
        fix=f"Write {expected}.",
        change=(wrong, right),
    )


def _unusual(package: Package) -> Iterator[Finding]:
    """Yield a warning if catkin warns of the name."""
    if _USUAL.fullmatch(package.name):
        return
    line = package.find_line("package.xml", "<name", 1)
    yield Finding(
        "package-name",
        f"catkin warns about the name {package.name}: a package's name begins with a lowercase"
        " letter, and has only lowercase letters, digits, - and _.",
        "package.xml",
        line,
        HABIT,
        expected="a name such as my_package",
        seen=package.line("package.xml", line),
        fix="Rename the package, if nobody uses it yet.",
    )


RULE = Rule(
    stage="files",
    needs=("manifest", "model", "launch"),
    findings=_findings,
    requirements={
        "package-name": Requirement(
            "The package has one name, in package.xml, CMake and launch file",
            "package",
            evidence.manifest,
        )
    },
)
