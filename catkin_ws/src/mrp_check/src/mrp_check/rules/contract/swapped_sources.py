# SPDX-License-Identifier: BSD-3-Clause
"""Each node is built from its own sources, and started from its own executable."""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Rule
from mrp_check.run.case import Case


def findings(case: Case) -> Iterator[Finding]:
    for node in case.coded:
        other = node.mistaken_for
        if other and node.mistaken_in(other) == "targets":
            target, own = node.model.executables()[node.executable], node.own_source()
            yield node.finding(
                "targets",
                f"The target {target.name} is built from {node.main}, the source of {other.name},"
                f" so {node.name} is a second {other.name}.",
                (target.file, target.line),
                expected=f"add_executable({target.name} {own or 'ITS OWN SOURCE'})",
                fix=f"Write {own} for {node.main}." if own else "Name its own source.",
            )
        elif other and node.started and node.started.file:
            yield node.finding(
                "launch-nodes",
                f"The launch file starts {node.executable} under the name {node.name}; it is the"
                f" executable of {other.name}.",
                (node.started.file, node.started.line or 1),
                expected=f"the executable of {node.name}",
                seen=f'type="{node.executable}"',
                fix="Name the node's own executable as its type.",
            )


RULE = Rule("static", ("facts",), findings, also=("targets", "launch-nodes"), only=CONTRACT)
