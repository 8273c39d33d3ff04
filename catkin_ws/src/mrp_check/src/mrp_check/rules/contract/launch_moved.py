# SPDX-License-Identifier: BSD-3-Clause
"""The launch file follows a group in which it is included."""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Rule
from mrp_check.run.case import Case


def findings(case: Case) -> Iterator[Finding]:
    spec, seen = case.spec, case.observed
    if seen.moved is None:
        return
    for node in seen.moved.nodes:
        if node.name in spec.nodes and not node.namespace.startswith("/check_moved/"):
            yield Finding(
                "namespace",
                f"Included in another group, the launch file starts {node.name} in"
                f" {node.namespace} anyway, because its namespace begins with a slash.",
                node.file,
                node.line,
                expected=f"/another_group{node.namespace}",
                seen=node.namespace,
                node=node.name,
            )
            return


RULE = Rule("run", ("nodes",), findings, also=("namespace",), only=CONTRACT)
