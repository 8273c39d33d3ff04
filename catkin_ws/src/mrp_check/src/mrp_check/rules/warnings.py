# SPDX-License-Identifier: BSD-3-Clause
"""ROS prints no warnings."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check import evidence
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running.node import Node, each_node

_NOT_A_NAME = re.compile(r"'(?P<name>[^']*)' is not a legal ROS")


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding if rospy has warned of a name."""
    for text in node.errors():
        found = _NOT_A_NAME.search(text)
        if found:
            name = found["name"]
            kind = Kind.PUBLISHER if node.wanted.publishing else Kind.SUBSCRIBER
            file, line = node.places.of_topic(node.name, kind, name)
            if "//" in name and file:  # where it is put together
                line = node.package.find_line(file, "get_namespace()") or line
            slashes = " It has two slashes: rospy.get_namespace() already ends with one."
            yield node.finding(
                "warnings",
                f"{node.name} uses the name '{name}', which ROS warns of."
                + (slashes if "//" in name else ""),
                (file, line),
                WARNING,
                expected=name.replace("//", "/"),
                seen=name,
                why="e09-double-slash",
            )
            return


RULE = Rule(
    stage="run",
    order=80,
    needs=("nodes",),
    findings=each_node(_of),
    requirements={"warnings": Requirement("ROS prints no warnings", "wrong", evidence.alone)},
)
