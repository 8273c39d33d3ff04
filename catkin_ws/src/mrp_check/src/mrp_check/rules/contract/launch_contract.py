# SPDX-License-Identifier: BSD-3-Clause
"""The launch file does as the contract says: its group, and where lines come out."""

from __future__ import annotations

import re
from typing import Iterator, Sequence

from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.package.xml_file import Element
from mrp_check.run import evidence
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    yield from _group(case)
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


def _group(case: Case) -> Iterator[Finding]:
    launch, group = case.launch, case.spec.launch.group
    if not group or not launch or launch.error:
        return
    tags = launch.elements(case.package)
    wrong: dict[str, list[Started]] = {}
    for node in launch.nodes:
        if node.name in case.spec.nodes and node.namespace.strip("/") != group:
            wrong.setdefault(node.namespace, []).append(node)
    for namespace, nodes in wrong.items():
        yield _elsewhere(group, namespace, nodes, tags)
    plain = [
        (f, e)
        for f, e in tags
        if e.tag in ("group", "node", "include") and e.attributes.get("ns", "").strip("/") == group
    ]
    if plain and not wrong:
        file, element = plain[0]
        yield Finding(
            "launch-group",
            f"The group's name {group} is fixed in the launch file, so a second robot can't get"
            " another one when it's started.",
            file,
            element.line,
            HABIT,
            expected=f'<arg name="group" default="{group}"/> and ns="$(arg group)"',
            seen=f'ns="{element.attributes["ns"]}"',
            fix=f'Make it an argument: <arg name="group" default="{group}"/>.',
        )


def _elsewhere(
    group: str, namespace: str, nodes: Sequence[Started], tags: Sequence[tuple[str, Element]]
) -> Finding:
    """Return the Finding about nodes that are started in another namespace than the group's."""
    names = ", ".join(n.name for n in nodes)
    elements = [e for f, e in tags if f == nodes[0].file]
    return Finding(
        "launch-group",
        f"The launch file starts {names} in the namespace {namespace}; expected the group {group}.",
        nodes[0].file,
        _line(nodes, elements, any(e.tag == "group" and "ns" in e.attributes for _, e in tags)),
        node=nodes[0].name if len(nodes) == 1 else None,
        expected=f'<group ns="{group}"> around the nodes',
        seen=f"the namespace {namespace}",
        fix='Put the nodes into <group ns="$(arg group)">, with <arg name="group"'
        f' default="{group}"/> above it.',
    )


def _line(nodes: Sequence[Started], elements: Sequence[Element], has_groups: bool) -> int | None:
    """Return the line that gives nodes their namespace: an <arg>, a <group>, or their own."""
    line = nodes[0].line
    here = [e for e in elements if e.line == line]
    around = [
        e
        for e in elements
        if e.tag == "group" and "ns" in e.attributes and any(e in inner.parents for inner in here)
    ]
    if around and not any(e.tag == "node" and "ns" in e.attributes for e in here):
        argument = re.search(r"\$\(arg (\w+)\)", around[-1].attributes["ns"])
        given = [
            e.line
            for e in elements
            if argument
            and e.tag == "arg"
            and e.attributes.get("name") == argument.group(1)
            and {"default", "value"} & {*e.attributes}
        ]
        return [around[-1].line, *given][-1]
    if has_groups or len(nodes) == 1:
        return line
    return next(e.line for tag in ("group", "launch") for e in elements if e.tag == tag)


RULE = Rule(
    stage="files",
    needs=("launch",),
    findings=_findings,
    requirements={
        "launch-group": Requirement(
            "The launch file puts the nodes into the group", "namespaces", evidence.launch
        ),
        "launch-output": Requirement(
            "The nodes' lines appear on the screen", "launching", evidence.launch
        ),
    },
    only=CONTRACT,
)
