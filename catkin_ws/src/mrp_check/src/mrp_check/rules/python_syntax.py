# SPDX-License-Identifier: BSD-3-Clause
"""Python can read each script."""

from __future__ import annotations

from typing import Iterator

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule


def findings(case: Case) -> Iterator[Finding]:
    for problem in case.facts.problems:
        if problem.file not in case.facts.relevant:
            problem.severity = WARNING
            problem.message += " Nothing uses the file."
        yield problem


RULE = Rule(
    stage="static",
    order=10,
    needs=("facts",),
    findings=findings,
    requirements={
        "python-syntax": Requirement("Python can read each script", "wrong", evidence.python)
    },
)
