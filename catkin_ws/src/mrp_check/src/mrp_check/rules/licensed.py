# SPDX-License-Identifier: BSD-3-Clause
"""package.xml names a licence."""

from __future__ import annotations

from typing import Iterator

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.student.manifest import FILE


def _findings(case: Case) -> Iterator[Finding]:
    manifest, _ = case.manifest
    if manifest and "TODO" in manifest.licenses:
        # A tag may have an attribute, or go over several lines.
        tag = case.package.find_line(FILE, "<license", 1)
        yield Finding(
            "licensed",
            "package.xml has the licence that catkin_create_pkg wrote: nobody may use the package.",
            FILE,
            case.package.find_line(FILE, "TODO</license>", tag),
            WARNING,
            expected="the name of a licence, such as BSD-3-Clause",
            seen="<license>TODO</license>",
            fix="Choose a licence, and write its name.",
        )


RULE = Rule(
    stage="files",
    order=12,
    needs=("manifest",),
    findings=_findings,
    requirements={
        "licensed": Requirement(
            "package.xml names a licence", "building#package-xml", evidence.manifest
        )
    },
)
