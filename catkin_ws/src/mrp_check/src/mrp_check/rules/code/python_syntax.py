# SPDX-License-Identifier: BSD-3-Clause
"""Python can read each script."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.contract.finding import CERTAIN, HABIT, READ, Finding
from mrp_check.contract.requirements import Requirement, Rule


def findings(case: Case) -> Iterator[Finding]:
    of_nodes = {file for files in case.facts.sources.values() for file in files}
    for problem in case.facts.problems:
        if problem.file not in case.facts.relevant:
            problem.certainty = HABIT
            problem.message += " Nothing uses the file."
        elif problem.file not in of_nodes:
            problem.certainty = READ
        yield problem


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=findings,
    sure=CERTAIN,
    requirements={
        "python-syntax": Requirement("Python can read each script", "wrong", evidence.python)
    },
)
