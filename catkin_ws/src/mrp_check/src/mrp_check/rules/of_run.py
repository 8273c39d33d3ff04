# SPDX-License-Identifier: BSD-3-Clause
"""The stage run: what the nodes do, against what the spec says."""

from __future__ import annotations

import re

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.rules.console import console_findings
from mrp_check.rules.publishing import publisher_findings, relay_findings
from mrp_check.rules.subscribing import subscriber_findings
from mrp_check.rules.topics import moved_findings, topic_findings, warning_findings
from mrp_check.rules.wrapping import wrap_findings
from mrp_check.running.starting import name_findings, raised_findings


def _problems(case):
    for problem in case.observed.problems:
        yield Finding(
            "starts",
            f"The nodes could not be run: {problem}.",
            *_launch_place(case.package, case.spec, case.observed),
            expected="nodes that can be started",
        )
    yield from _launch_findings(case.package, case.spec, case.observed)


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


def _no_executable(node):
    if not node.has_executable:
        yield node.finding(
            "starts",
            f"{node.name} could not be run: it has no executable.",
            node.places.in_launch_file(node.name),
            expected=f"an executable for {node.name}",
        )


def _rule(findings, ids, needs_up=True):
    """Return the Rule that a function of one Node makes, for all that it can be asked of."""

    def of_all(case):
        for node in case.nodes.values():
            if node.is_up or not needs_up:
                yield from findings(node)

    return Rule(ids, ("nodes",), of_all)


_OF_ERRORS = ("python-names", "python-syntax", "type", "node-start")

RULES = (
    Rule(("starts",), ("nodes",), _problems),
    _rule(_no_executable, ("starts",), needs_up=False),
    _rule(lambda node: node.not_up, ("starts", "spin", "scripts", *_OF_ERRORS), needs_up=False),
    _rule(name_findings, ("node-name",), needs_up=False),
    _rule(raised_findings, ("callbacks", *_OF_ERRORS), needs_up=False),
    _rule(topic_findings, ("topic", "type", "namespace")),
    _rule(publisher_findings, ("values", "latch", "rate")),
    _rule(wrap_findings, ("wrap",)),
    _rule(subscriber_findings, ("received", "console", "queue", "callbacks")),
    _rule(relay_findings, ("values",)),
    _rule(console_findings, ("console",)),
    _rule(warning_findings, ("warnings",)),
    Rule(("namespace",), ("nodes",), lambda case: moved_findings(case.spec, case.observed)),
)
