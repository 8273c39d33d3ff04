# SPDX-License-Identifier: BSD-3-Clause
"""Each node starts and stays up."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, HINT, Finding, Where
from mrp_check.contract.names import last_part
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import Package
from mrp_check.run import blame, evidence
from mrp_check.run.case import Case
from mrp_check.run.node import Node
from mrp_check.run.observing import Observed
from mrp_check.run.starting import traceback_of
from mrp_check.run.traces import ROS_TOPICS
from mrp_check.run.words import code_text

_OF_ACTIONS = {"feedback", "result", "status"}


def findings(case: Case) -> Iterator[Finding]:
    yield from _problems(case)
    yield from _launch_findings(case.package, case.observed)
    yield from _killed(case.facts, case.observed)
    for node in case.nodes.values():
        if not node.has_executable and not _lacks_what_is_not_here(case, node):
            yield node.finding(
                "starts",
                f"{node.name} couldn't be run: it has no executable.",
                node.places.in_launch_file(node.name),
                expected=f"an executable for {node.name}",
            )
    for node in case.nodes.values():
        for finding in node.not_up:
            if case.spec.is_contract or weigh_start(case, node, finding):
                yield finding


def _lacks_what_is_not_here(case: Case, node: Node) -> bool:
    """Return whether a node was not built only as this machine lacks what it needs."""
    if case.spec.is_contract or case.built and case.built.ok:
        return False
    files = case.facts.sources.get(node.name, ())
    headers = (header for file in files for header, _ in uses.includes(case.package, file))
    return any(uses.absent_header(case.package, header) for header in headers)


def _problems(case: Case) -> Iterator[Finding]:
    for problem in case.observed.problems:
        yield Finding(
            "starts",
            f"The nodes couldn't be run: {problem}.",
            *_launch_place(case.package, case.observed),
            expected="nodes that can be started",
        )


def _launch_findings(package: Package, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if roslaunch gives up, and ends what it has started."""
    if not seen.own_launch or not seen.launch or seen.launch.ending != "itself":
        return
    texts = [text for _, _, text in seen.launch.lines if text.strip()]
    for index, text in enumerate(texts):
        if not text.startswith("RLException: "):
            continue
        message = " ".join(texts[index : index + 2]).partition(": ")[2]
        named = re.search(r"__name:=(\w+)", message)
        why = message.partition(" __name:=")[0]
        started = seen.started.get(named.group(1)) if named else None
        place = _launch_place(package, seen)
        if started and started.file:
            place = started.file, started.line
        prefix = f' launch-prefix="{started.prefix}"' if started and started.prefix else ""
        yield Finding(
            "starts",
            f"roslaunch gives up, and ends all nodes: {why}",
            *place,
            expected="a command that can be run for each node",
            seen=why,
            fix=f"Remove{prefix}: it starts the node with another program." if prefix else "",
            node=named.group(1) if named else None,
        )
        return


def _killed(facts: Facts, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if something has killed roslaunch: only the package itself can reach it."""
    code = seen.launch.code if seen.launch else None
    if code is not None and code < 0:
        yield Finding(
            "starts",
            "A node kills roslaunch, and perhaps the other nodes.",
            *facts.first(Kind.KILLS, Kind.STARTS),
            expected="nodes that end only themselves",
            seen=f"roslaunch ended {code_text(code)}",
        )


def _launch_place(package: Package, seen: Observed) -> Where:
    for started in seen.started.values():
        if started.file:
            return started.file, started.line
    return ("CMakeLists.txt" if "CMakeLists.txt" in package.files else "package.xml"), 1


def weigh_start(case: Case, node: Node, finding: Finding) -> bool:
    """Set how sure it is that the package is to blame for the end of a node by itself.

    Return whether this is the finding to report: if the node only dies under its launch file,
    rules/run/exceptions.py says how.
    """
    runs = (run for run in case.observed.launches if run.file)
    launched = next((run for run in runs if run.died().get(node.name)), None)
    code = node.direct.code if node.direct else None
    if code == 0:
        # It may have meant to end, unless it was waiting for messages.
        if not _is_left_alone(node):
            finding.certainty = HINT
        elif node.places.facts.exits(node.name):
            finding.certainty = HABIT
        return launched is None
    own = rf"(No module named|cannot import name .* from) '{case.package.name}\b"
    if case.built is None and re.search(own, finding.seen):
        finding.certainty = HINT  # it is not made where CMake failed
    if finding.certainty == HINT:
        return True
    if launched:
        finding.message = f"{finding.message.rstrip('.')}. It dies {launched.where}, too."
        add_name_that_is_set(case, finding)
    found = traceback_of(node)
    end = blame.of_lines(node.errors(), code)
    end = end._replace(kind=found[1], text=found[2]) if found else end
    finding.certainty = blame.certainty(case, node.name, end, launched)
    return True


def add_name_that_is_set(case: Case, finding: Finding) -> None:
    """Add the name under which a launch file sets the parameter that a node doesn't find."""
    asked_for = re.search(r"KeyError: '[~/]?([^']+)'", finding.seen)
    given = (name for launch in case.launches for name in launch.params)
    other = next((name for name in given if asked_for and name.endswith(f"/{asked_for[1]}")), None)
    if other:
        finding.message += f" The launch file sets {other}, which is another name."
        finding.fix = (
            "Set it inside <node> if the node asks for it with ~, and outside if it asks without."
        )


def _is_left_alone(node: Node) -> bool:
    """Return whether a node ended that was to be called back."""
    heard = {registration.topic for registration in node.seen_alone.subscriptions} - ROS_TOPICS
    if node.places.facts.of(node.name, Kind.COMMANDS):
        # Those of the client itself call nothing of the node's.
        heard = {topic for topic in heard if last_part(topic) not in _OF_ACTIONS}
    return bool(heard)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=findings,
    requirements={"starts": Requirement("Each node starts and stays up", "launching", evidence.up)},
    also=("spin", "scripts", "python-names", "python-syntax", "type", "node-start"),
)
