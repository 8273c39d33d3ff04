# SPDX-License-Identifier: BSD-3-Clause
"""Each node waits for callbacks."""

from __future__ import annotations

import ast
from typing import Iterator, Sequence

from mrp_check.code.source_node import SourceNode, each_node
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence


def _of(node: SourceNode) -> Iterator[Finding]:
    waits, spins = node.places(Kind.LOOP, Kind.SLEEP), node.places(Kind.SPIN)
    if spins and {place.text for place in spins} == {"spinOnce"}:
        if not waits:
            yield _only_once(node, spins[0])
        return
    if spins:
        yield from _made_too_late(node, spins)
        return
    called_back = node.places(Kind.SUBSCRIBER)
    if not node.is_python:
        timers = [place for place in node.places(Kind.TIMER) if place.oneshot is not True]
        line = node.package.line
        called_back += [timer for timer in timers if "Rate" not in line(timer.file, timer.line)]
    # rospy calls back in threads of its own: there a loop is enough.
    if waits and (node.is_python or not called_back):
        return
    # A client of an action waits for what comes of it.
    if node.is_python and not called_back and node.places(Kind.WAITS, Kind.COMMANDS):
        return
    if called_back or node.places(Kind.TIMER, Kind.PUBLISHER):
        yield _never(node, bool(waits))


def _only_once(node: SourceNode, spin: Place) -> Finding:
    return node.finding(
        "spin",
        "ros::spinOnce() calls the callbacks of what has arrived, and returns at once, so the"
        " program then ends.",
        spin,
        expected="ros::spin() at the end of main",
        fix="Write ros::spin() for ros::spinOnce().",
        change=("spinOnce", "spin"),
    )


def _never(node: SourceNode, loops: bool) -> Finding:
    call = "rospy.spin()" if node.is_python else "ros::spin()"
    return node.finding(
        "spin",
        f"{node.main} never calls {call}, so "
        + ("no callback is ever called." if loops else "the program ends at once."),
        node.facts.end_of_main(node.name) or (node.main, _last_line(node)),
        expected=f"{call} at the end of main",
        seen="no such call",
        fix=f"Add {call}{'' if node.is_python else ';'} at the end of main.",
    )


def _last_line(node: SourceNode) -> int:
    """Return the last line of the main source in which something stands."""
    lines = node.package.lines(node.main)
    return max((n for n, text in enumerate(lines, 1) if text.strip()), default=1)


def _made_too_late(node: SourceNode, spins: Sequence[Place]) -> Iterator[Finding]:
    """Yield a finding if the node's parts are made below a spin() of the same function."""
    classes = {p.text for p in node.places(Kind.FUNCTION) if (p.text or "")[:1].isupper()}
    parts = Kind.HANDLE, Kind.PUBLISHER, Kind.SUBSCRIBER
    made = {(p.file, p.line) for p in node.places(*parts)}
    for file in node.files:
        source = node.facts.python.get(file)
        for call in source.nodes(ast.Call) if source else ():
            if getattr(call.func, "id", "") in classes:
                made.add((file, call.lineno))
    for spin in spins:
        ends = [f.end for f in node.places(Kind.FUNCTION) if f.is_around(spin)]
        if spin.text not in (None, "spin", "waitForShutdown") or not ends:
            continue
        late = [n for file, n in made if file == spin.file and spin.line < n <= min(ends)]
        if late:
            spins_by = "rospy.spin()" if node.is_python else "ros::spin()"
            yield node.finding(
                "spin",
                f"{spins_by} only returns when the node ends, so what's below it, on line"
                f" {min(late)}, is created too late.",
                spin,
                expected=f"{spins_by} below everything that the node creates",
                fix=f"Move it below line {min(late)}.",
            )
            return


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=each_node(_of),
    requirements={"spin": Requirement("Each node waits for callbacks", "publisher", evidence.read)},
)
