# SPDX-License-Identifier: BSD-3-Clause
"""package.xml describes the package."""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.manifest import FILE
from mrp_check.run import evidence
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    manifest, _ = case.manifest
    if manifest and manifest.description == f"The {manifest.name} package":
        yield Finding(
            "described",
            "package.xml has the description that catkin_create_pkg wrote.",
            FILE,
            case.package.find_line(FILE, "<description>"),
            HABIT,
            expected="a sentence that says what the package does",
            seen=manifest.description,
            fix="Write what the package does.",
        )


RULE = Rule(
    stage="files",
    needs=("manifest",),
    findings=_findings,
    requirements={
        "described": Requirement(
            "package.xml describes the package", "building#package-xml", evidence.manifest
        )
    },
)
