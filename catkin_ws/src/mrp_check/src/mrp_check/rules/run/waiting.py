# SPDX-License-Identifier: BSD-3-Clause
"""What the nodes of a package wait for, and none of it gives: services, actions and parameters."""

from __future__ import annotations

from typing import Iterator, NamedTuple

from mrp_check.code import uses
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.names import nearest
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case

_ALIKE = 0.8
_OF_ROSCORE = {"rosdistro", "rosversion", "run_id"}


class _Sought(NamedTuple):
    """What is waited for: how it is asked for, how it is given, and how to say so."""

    asks: Kind
    gives: Kind
    what: str
    nobody: str
    other: str


_SOUGHT = (
    _Sought(
        Kind.ASKS,
        Kind.OFFERS,
        "service",
        "no node of this package offers it.",
        "the package offers {near}, which nobody asks for.",
    ),
    _Sought(
        Kind.COMMANDS,
        Kind.SERVES,
        "action",
        "no node of this package serves it.",
        "the package serves {near}, which nobody commands.",
    ),
    _Sought(
        Kind.READS,
        Kind.SETS,
        "parameter",
        "no launch file and no node of this package sets it.",
        "the package sets {near}, which nobody reads.",
    ),
)


def _findings(case: Case) -> Iterator[Finding]:
    # What no node is made of may be built one day: it gives what it says.
    every = case.facts.asked({place.file for place in case.facts.places})
    own = uses.made(case.package)
    # Who reads gains has all of gains/p, too.
    params = {
        part for launch in case.launches for name in launch.params for part in name.split("/")
    }
    for sought in _SOUGHT:
        given = {one.base for one in every if one.kind is sought.gives}
        if sought.asks is Kind.READS:
            given |= params | _OF_ROSCORE
        taken = {one.base for one in every if one.kind in (sought.asks, Kind.KNOWS)}
        for node in case.facts.sources:
            first = {one.base: one for one in case.facts.of(node, sought.asks)[::-1] if one.text}
            for place in (one for base, one in first.items() if base not in given):
                # What somebody asks for is not misspelt.
                same = {o.base for o in every if o.kind is sought.gives and o.type == place.type}
                same = (same if place.type in own else set()) & given - taken
                near = nearest(place.base, given - taken, _ALIKE)
                near = near or (min(same) if len(same) == 1 else None)
                yield _finding(node, place, near, sought)
    for node in case.facts.sources:
        yield from _unwaited(case, node)


def _finding(node: str, place: Place, near: str | None, sought: _Sought) -> Finding:
    head = f"{node} waits for the {sought.what} {place.text}: "
    at = place.file, place.line
    if near is None:
        return Finding("starts", head + sought.nobody, *at, HINT, node=node)
    return Finding(
        "starts",
        head + sought.other.format(near=near),
        *at,
        HABIT,
        expected=near,
        seen=place.text or "",
        fix="Give both one name.",
        node=node,
    )


def _unwaited(case: Case, node: str) -> Iterator[Finding]:
    """Yield a warning if a node is launched with what offers the service that it calls, and doesn't
    wait until that is there."""
    place = case.facts.unwaited(case.facts.sources[node])
    if not place or not _is_launched_with(case, node):
        return
    is_python = case.package.kind(place.file) == "python"
    wait = "rospy.wait_for_service()" if is_python else "waitForExistence() of the client"
    yield Finding(
        "starts",
        f"{node} calls a service without waiting until it's offered: if the node that offers it"
        " starts later, the call fails.",
        place.file,
        place.line,
        HABIT,
        expected=f"{wait} before the call",
        seen=case.package.line(place.file, place.line),
        fix=f"Call {wait} first.",
        node=node,
    )


def _is_launched_with(case: Case, node: str) -> bool:
    """Return whether a launch file starts a node, and one that offers what it asks for."""
    asks = {place.base for place in case.facts.of(node, Kind.ASKS)}
    offers = {
        other
        for other in case.facts.sources
        if asks & {place.base for place in case.facts.of(other, Kind.OFFERS)}
    }
    started = [{one.type for one in launch.nodes} for launch in case.launches]
    return any(node in names and names & offers for names in started)


RULE = Rule("run", ("nodes",), _findings, also=("starts",), only=ANY)
