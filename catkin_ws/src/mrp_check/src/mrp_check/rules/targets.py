# SPDX-License-Identifier: BSD-3-Clause
"""The sources of each target are there."""

from __future__ import annotations

from typing import Iterator

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import nearest, perhaps


def _findings(case: Case) -> Iterator[Finding]:
    for target in case.model.targets.values():
        for source, file, line in target.missing:
            near = nearest(source, case.package.of_kind("cpp"))
            yield Finding(
                "targets",
                f"The target {target.name} is made of {source}, and there is no such file."
                + perhaps(near),
                file,
                line,
                expected="the name of a file, relative to CMakeLists.txt",
                seen=source,
                fix=f"Write {near} for {source}." if near else "Name a file that is there.",
            )


RULE = Rule(
    stage="files",
    order=50,
    needs=("model",),
    findings=_findings,
    requirements={
        "targets": Requirement(
            "Each executable is built of its own sources",
            "wrong#a-target-is-built-from-another-node-s-source",
            evidence.cpp,
        )
    },
)
