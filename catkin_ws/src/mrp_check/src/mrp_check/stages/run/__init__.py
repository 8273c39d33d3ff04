# SPDX-License-Identifier: BSD-3-Clause
"""The stage run: what the nodes do, against what the spec says."""

from __future__ import annotations

import re

from mrp_check.finding import ERROR, Finding
from mrp_check.stages.observing import observed
from mrp_check.stages.places import Places
from mrp_check.stages.run.console import console_findings
from mrp_check.stages.run.node import Node
from mrp_check.stages.run.publishing import publisher_findings, relay_findings
from mrp_check.stages.run.starting import name_findings, raised_findings, start_findings
from mrp_check.stages.run.subscribing import subscriber_findings
from mrp_check.stages.run.topics import moved_findings, topic_findings, warning_findings
from mrp_check.stages.run.wrapping import wrap_findings


def findings(package, spec, workspace):
    """Yield a Finding for each thing that running the nodes shows to be wrong."""
    seen = observed(package, spec, workspace)
    places = Places(package, spec, workspace, seen)
    for problem in seen.problems:
        yield Finding(
            "starts",
            f"The nodes could not be run: {problem}.",
            *_launch_place(package, spec, seen),
            expected="nodes that can be started",
        )
    yield from _launch_findings(package, spec, seen)
    for node in spec.nodes.values():
        yield from _node_findings(Node(node, package, spec, seen, places))
    yield from moved_findings(spec, seen)


def _launch_findings(package, spec, seen):
    """Yield a Finding if roslaunch gives up, and ends what it has started."""
    if not seen.own_launch or not seen.launch or seen.launch["ending"] != "itself":
        return
    texts = [text for _, _, text in seen.launch["lines"] if text.strip()]
    for index, text in enumerate(texts):
        if not text.startswith("RLException: "):
            continue
        said = " ".join(texts[index : index + 2]).partition(": ")[2]
        named = re.search(r"__name:=(\w+)", said)
        why = said.partition(" __name:=")[0]
        started = seen.started.get(named.group(1)) if named else None
        place = _launch_place(package, spec, seen)
        if started and started.file:
            place = started.file, started.line
        prefix = f' launch-prefix="{started.prefix}"' if started and started.prefix else ""
        yield Finding(
            "starts",
            f"roslaunch gives up, and ends all nodes: {why}",
            *place,
            expected="a command that can be run for each node",
            seen=why,
            fix=f"Take{prefix} away: it starts the node by another program." if prefix else "",
            node=named.group(1) if named else None,
        )
        return


def _launch_place(package, spec, seen):
    for started in seen.started.values():
        if started.file:
            return started.file, started.line
    return ("CMakeLists.txt" if "CMakeLists.txt" in package.files else "package.xml"), 1


def _node_findings(node):
    if not node.has_executable:
        yield node.finding(
            "starts",
            f"{node.name} could not be run: it has no executable.",
            node.places.in_launch_file(node.name),
            expected=f"an executable for {node.name}",
        )
        return
    not_up = list(start_findings(node))
    yield from not_up
    yield from name_findings(node)
    raised = list(raised_findings(node)) if not not_up else []
    yield from raised
    if any(f.severity == ERROR for f in not_up):
        return
    yield from topic_findings(node)
    yield from publisher_findings(node)
    yield from wrap_findings(node)
    yield from subscriber_findings(node)
    yield from relay_findings(node)
    yield from console_findings(node)
    yield from warning_findings(node)
