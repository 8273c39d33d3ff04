# SPDX-License-Identifier: BSD-3-Clause
"""Each node starts and stays up."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.spec import Spec
from mrp_check.running.node import Node
from mrp_check.running.observing import Observed
from mrp_check.running.words import code_text
from mrp_check.student.package import Package

_KILLS = r"\bkill(pg)?\s*\(|\b(pkill|killall)\b"


def findings(case: Case) -> Iterator[Finding]:
    yield from _problems(case)
    yield from _launch_findings(case.package, case.spec, case.observed)
    yield from _killed(case.package, case.observed)
    for node in case.nodes.values():
        if not node.has_executable:
            yield _no_executable(node)
    for node in case.nodes.values():
        yield from node.not_up


def _problems(case: Case) -> Iterator[Finding]:
    for problem in case.observed.problems:
        yield Finding(
            "starts",
            f"The nodes could not be run: {problem}.",
            *_launch_place(case.package, case.spec, case.observed),
            expected="nodes that can be started",
        )


def _launch_findings(package: Package, spec: Spec, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if roslaunch gives up, and ends what it has started."""
    if not seen.own_launch or not seen.launch or seen.launch.ending != "itself":
        return
    texts = [text for _, _, text in seen.launch.lines if text.strip()]
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


def _killed(package: Package, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if something has killed roslaunch: only the package itself can reach it."""
    code = seen.launch.code if seen.launch else None
    if code is not None and code < 0:
        files = package.of_kind("python", "cpp")
        place: Where = package.first_match(files, _KILLS) or (None, None)
        yield Finding(
            "starts",
            "A node kills roslaunch, and perhaps the other nodes.",
            *place,
            expected="nodes that end no program but themselves",
            seen=f"roslaunch ended {code_text(code)}",
        )


def _launch_place(package: Package, spec: Spec, seen: Observed) -> Where:
    for started in seen.started.values():
        if started.file:
            return started.file, started.line
    return ("CMakeLists.txt" if "CMakeLists.txt" in package.files else "package.xml"), 1


def _no_executable(node: Node) -> Finding:
    return node.finding(
        "starts",
        f"{node.name} could not be run: it has no executable.",
        node.places.in_launch_file(node.name),
        expected=f"an executable for {node.name}",
    )


RULE = Rule(
    stage="run",
    order=10,
    needs=("nodes",),
    findings=findings,
    requirements={"starts": Requirement("Each node starts and stays up", "launching", evidence.up)},
    also=("spin", "scripts", "python-names", "python-syntax", "type", "node-start"),
)
