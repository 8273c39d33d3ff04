# SPDX-License-Identifier: BSD-3-Clause
"""No node is made of another node's sources: by CMakeLists.txt, or by the launch file."""

from __future__ import annotations

from mrp_check.contract.requirements import Rule


def findings(case):
    for node in case.coded:
        other = node.mistaken_for
        if other and node.mistaken_in(other) == "targets":
            yield _target(node, other)
        elif other:
            yield _launch(node, other)


def _target(node, other):
    target, own = node.model.executables()[node.executable], node.own_source()
    return node.finding(
        "targets",
        f"The target {target.name} is made of {node.main}, which is the source of"
        f" {other.name}: {node.name} is then a second {other.name}.",
        (target.file, target.line),
        expected=f"add_executable({target.name} {own or 'ITS OWN SOURCE'})",
        fix=f"Write {own} for {node.main}." if own else "Name its own source.",
    )


def _launch(node, other):
    return node.finding(
        "launch-nodes",
        f"The launch file starts {node.executable} under the name {node.name}; it is the"
        f" executable of {other.name}.",
        (node.started.file, node.started.line or 1),
        expected=f"the executable of {node.name}",
        seen=f'type="{node.executable}"',
        fix="Name the node's own executable as its type.",
    )


RULE = Rule("static", 28, ("facts",), findings, also=("targets", "launch-nodes"))
