# SPDX-License-Identifier: BSD-3-Clause
"""Python can read each script."""

from __future__ import annotations

from mrp_check.contract.finding import WARNING
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence


def findings(case):
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
