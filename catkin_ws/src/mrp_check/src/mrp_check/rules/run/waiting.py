# SPDX-License-Identifier: BSD-3-Clause
"""What the nodes of a package wait for, and none of it gives: services and parameters."""

from __future__ import annotations

import re
from typing import Iterator, NamedTuple

from mrp_check.case.case import Case
from mrp_check.code import asked, uses
from mrp_check.code.asked import Said
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import nearest

_ALIKE = 0.8
_GIVES = "offers", "serves", "sets"
_OF_ROSCORE = {"rosdistro", "rosversion", "run_id"}


class _Words(NamedTuple):
    """How to say what is waited for: nobody gives it, or the package gives another name."""

    what: str
    nobody: str
    other: str


_SERVICE = _Words(
    "service",
    "no node of this package offers it.",
    "the package offers {near}, which nobody asks for.",
)
_ACTION = _Words(
    "action",
    "no node of this package serves it.",
    "the package serves {near}, which nobody commands.",
)
_PARAMETER = _Words(
    "parameter",
    "no launch file and no node of this package sets it.",
    "the package sets {near}, which nobody reads.",
)


def _findings(case: Case) -> Iterator[Finding]:
    said = {node: [*asked.of(case.package, files)] for node, files in case.facts.sources.items()}
    for node, files in case.facts.sources.items():
        yield from _unwaited(case, node, files, said)
    # What no node is made of may be built one day: it gives what it says, and asks for nothing.
    sources = sorted(case.package.of_kind("cpp", "header", "python"))
    beside = [one for one in asked.of(case.package, sources) if one.what in _GIVES]
    every = [one for found in said.values() for one in found] + beside
    # Who reads gains has all of gains/p, too.
    params = {part for one in case.launches for name in one.params for part in name.split("/")}
    services = {one.base for one in every if one.what == "offers"}
    given = params | {one.base for one in every if one.what == "sets"} | _OF_ROSCORE
    own = uses.made(case.package)
    yield from _lacking(said, "asks", services, every, _SERVICE, own)
    served = {one.base for one in every if one.what == "serves"}
    if served or not case.package.first_match(sources, r"\bSimpleActionServer\b"):
        yield from _lacking(said, "commands", served, every, _ACTION, own)
    yield from _lacking(said, "reads", given, every, _PARAMETER, own)


def _is_first(case: Case, file: str, line: int) -> bool:
    """Return whether main() of a C++ source comes to a line once, before it spins or loops."""
    before = "\n".join(uses.code(case.package, file).split("\n")[:line])
    _, is_main, start = before.rpartition("int main")
    return bool(is_main) and not re.search(r"\b(?:while|for)\b|\bspin", start)


def _unwaited(
    case: Case, node: str, files: list[str], said: dict[str, list[Said]]
) -> Iterator[Finding]:
    """Yield a warning if a node calls a service once, or is launched with what offers it, and does
    not wait until it is there."""
    place = asked.unwaited(case.package, files)
    if not place:
        return
    if not _is_first(case, *place):
        if case.facts.unread & {*files}:
            return
        if case.facts.of(node, Kind.SPIN, Kind.LOOP) and not _is_launched_with(case, node, said):
            return
    is_python = case.package.kind(place[0]) == "python"
    wait = "rospy.wait_for_service()" if is_python else "waitForExistence() of the client"
    yield Finding(
        "starts",
        f"{node} calls a service, and does not wait until it is offered: if the node that offers it"
        " starts later, the call fails.",
        *place,
        HABIT,
        expected=f"{wait} before the call",
        seen=case.package.line(place[0], place[1]),
        fix=f"Call {wait} first.",
        node=node,
    )


def _is_launched_with(case: Case, node: str, said: dict[str, list[Said]]) -> bool:
    """Return whether a launch file starts a node, and one that offers what it asks for."""
    asks = {one.base for one in said[node] if one.what == "asks"}
    offers = {
        n for n, found in said.items() for s in found if s.what == "offers" and s.base in asks
    }
    started = [{one.type for one in launch.nodes} for launch in case.launches]
    return any(node in names and names & offers for names in started)


def _lacking(
    said: dict[str, list[Said]],
    what: str,
    given: set[str],
    every: list[Said],
    words: _Words,
    own: set[str],
) -> Iterator[Finding]:
    """Yield a Finding for each name that is asked for, and that nothing of the package gives.

    own: the types of the package's own
    """
    taken = {one.base for one in every if one.what in (what, "knows")}
    for node, found in said.items():
        told: set[str] = set()
        for one in found:
            if one.what == what and one.base not in given | told:
                told.add(one.base)
                # What somebody asks for is not misspelt.
                near = nearest(one.base, given - taken, _ALIKE)
                same = {other.base for other in every if other.type == one.type in own}
                same &= given - taken
                yield _finding(node, one, near or (min(same) if len(same) == 1 else None), words)


def _finding(node: str, one: Said, near: str | None, words: _Words) -> Finding:
    head = f"{node} waits for the {words.what} {one.name}: "
    if near is None:
        return Finding("starts", head + words.nobody, one.file, one.line, HINT, node=node)
    return Finding(
        "starts",
        head + words.other.format(near=near),
        one.file,
        one.line,
        HABIT,
        expected=near,
        seen=one.name,
        fix="Give both one name.",
        node=node,
    )


RULE = Rule("run", ("nodes",), _findings, also=("starts",), only=ANY)
