# SPDX-License-Identifier: BSD-3-Clause
"""What the nodes print comes to the screen."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule


def findings(case: Case) -> Iterator[Finding]:
    for node in case.launch.of_spec(case.spec) if case.launch else ():
        if node.output != "screen":
            yield Finding(
                "launch-output",
                f'What {node.name} prints goes to a log file: its <node> has no output="screen".',
                node.file,
                node.line,
                node=node.name,
                expected='output="screen"',
                seen=f'output="{node.output}"',
                fix='Add output="screen".',
            )


RULE = Rule(
    stage="files",
    needs=("launch",),
    findings=findings,
    requirements={
        "launch-output": Requirement(
            "The nodes' lines come to the screen", "launching", evidence.launch
        )
    },
    only=CONTRACT,
)
