# SPDX-License-Identifier: BSD-3-Clause
"""The launch file puts the nodes into the spec's group, whose name can be changed."""

from __future__ import annotations

import re

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence


def findings(package, spec, launch, tags):
    """Yield findings about the namespace of the spec's nodes."""
    group = spec.launch.group
    if not group:
        return
    wrong = {}
    for node in launch.nodes:
        if node.name in spec.nodes and node.namespace.strip("/") != group:
            wrong.setdefault(node.namespace, []).append(node)
    for namespace, nodes in wrong.items():
        node = nodes[0]
        seen = f"the namespace {namespace}"
        line, file = node.line, node.file
        groups = [(f, e) for f, e in tags if e.tag == "group" and "ns" in e.attributes]
        inside = [
            (f, e)
            for f, e in groups
            if f == node.file
            and any(t.line == node.line and e in t.parents for g, t in tags if g == node.file)
        ]
        own = next(
            (
                e
                for f, e in tags
                if f == node.file
                and e.line == node.line
                and e.tag == "node"
                and "ns" in e.attributes
            ),
            None,
        )
        if inside and own is None:
            file, line = inside[-1][0], inside[-1][1].line
            argument = re.search(r"\$\(arg (\w+)\)", inside[-1][1].attributes["ns"])
            for f, e in tags:
                if (
                    argument
                    and e.tag == "arg"
                    and e.attributes.get("name") == argument.group(1)
                    and ("default" in e.attributes or "value" in e.attributes)
                    and f == file
                ):
                    line = e.line
        elif groups == [] and len(nodes) > 1:
            launch_tag = [e for f, e in tags if f == node.file and e.tag == "launch"]
            groups_without = [e for f, e in tags if f == node.file and e.tag == "group"]
            line = groups_without[0].line if groups_without else launch_tag[0].line
        names = ", ".join(n.name for n in nodes)
        yield Finding(
            "launch-group",
            f"The launch file starts {names} in {seen}; expected the group {group}.",
            file,
            line,
            node=node.name if len(nodes) == 1 else None,
            expected=f'<group ns="{group}"> around the nodes',
            seen=seen,
            fix=f'Put the nodes into <group ns="$(arg group)">, with <arg name="group"'
            f' default="{group}"/> above it.',
        )
    plain = [
        (f, e)
        for f, e in tags
        if e.tag in ("group", "node", "include") and e.attributes.get("ns", "").strip("/") == group
    ]
    if plain and not wrong:
        file, element = plain[0]
        yield Finding(
            "launch-group",
            f"The group's name {group} is written into the launch file: a second robot cannot be"
            " given another one when it is started.",
            file,
            element.line,
            WARNING,
            expected=f'<arg name="group" default="{group}"/> and ns="$(arg group)"',
            seen=f'ns="{element.attributes["ns"]}"',
            fix=f'Make it an argument: <arg name="group" default="{group}"/>.',
        )


def _findings(case):
    launch = case.launch
    if launch and not launch.error:
        yield from findings(case.package, case.spec, launch, launch.elements(case.package))


RULE = Rule(
    stage="files",
    order=110,
    needs=("launch",),
    findings=_findings,
    requirements={
        "launch-group": Requirement(
            "The launch file puts the nodes into the group", "namespaces", evidence.launch
        )
    },
)
