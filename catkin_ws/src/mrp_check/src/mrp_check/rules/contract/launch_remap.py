# SPDX-License-Identifier: BSD-3-Clause
"""The launch file renames no topic on which the nodes are to meet."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Rule
from mrp_check.contract.spec import Spec
from mrp_check.package.package import Package
from mrp_check.package.xml_file import elements


def findings(case: Case) -> Iterator[Finding]:
    for node in case.launch.of_spec(case.spec) if case.launch else ():
        yield from _of(case.package, case.spec, node)


def _of(package: Package, spec: Spec, node: Started) -> Iterator[Finding]:
    wanted = spec.nodes[node.name]
    for topic in dict.fromkeys([*wanted.publishing, *wanted.subscribing]):
        base = node.namespace.rstrip("/") + "/"
        own = {topic.name, base + topic.name}
        for old, new in node.remaps:
            if old in own and new not in own:
                yield Finding(
                    "topic",
                    f"The launch file renames the topic {old} of {node.name} to {new}:"
                    " the nodes do not meet there.",
                    node.file,
                    remap_line(package, node, old, new),
                    node=node.name,
                    expected=f"the topic {topic.name}",
                    seen=f"{old} renamed to {new}",
                    fix="Take the <remap> out.",
                )


def remap_line(package: Package, node: Started, old: str, new: str) -> int | None:
    """Return the line of the <remap> that renames `old` to `new`."""
    # A file of another package has no lines that could be named.
    for element in elements(package.bytes(node.file)) if node.file else ():
        if element.tag == "remap" and old.endswith(
            element.attributes.get("from", "?").lstrip("~/")
        ):
            if new.endswith(element.attributes.get("to", "?").lstrip("~/")):
                return element.line
    return node.line


RULE = Rule(stage="files", needs=("launch",), findings=findings, also=("topic",), only=CONTRACT)
