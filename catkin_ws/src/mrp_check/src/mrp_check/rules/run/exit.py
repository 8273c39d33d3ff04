# SPDX-License-Identifier: BSD-3-Clause
"""Each node ends cleanly on Ctrl-C."""

from __future__ import annotations

import ast
import re
import signal
from typing import Iterator, Sequence

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Alone, LaunchResult
from mrp_check.contract.finding import HABIT, HINT, Finding, Where
from mrp_check.contract.names import last_part
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.spec import Shutdown
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.run.node import Node
from mrp_check.run.source_lines import Traceback
from mrp_check.run.words import code_text, last_words

_BEFORE = 0.1  # seconds: what is printed so shortly before it is asked belongs to its end, too
# What rospy itself may say when a message is published at the very moment of the end.
_ENDED = ("KeyboardInterrupt", "ROSInterruptException")
_AT_THE_END = ("closed topic", "closed during publish", "ROSInterruptException: rospy shutdown")


def findings(case: Case) -> Iterator[Finding]:
    """Yield a Finding for each node that does not end as the spec says."""
    for node in case.nodes.values():
        if node.direct and node.direct.asked is not None:
            for finding in _of(node, node.direct, node.direct.asked, case.spec.shutdown):
                # Whatever its exit code, it ended: without a contract, nobody asks for more.
                if not case.spec.is_contract and _has_ended(node.direct):
                    finding.certainty = HINT if _is_interrupted(node.direct) else HABIT
                yield finding


def _has_ended(direct: Alone) -> bool:
    """Return whether a node ended by itself on Ctrl-C, though perhaps not cleanly."""
    if direct.stopped_in is None:
        return False
    return (direct.code or 0) >= 0 or _is_interrupted(direct)


def _is_interrupted(direct: Alone) -> bool:
    """Return whether it says so: rospy raises this at Ctrl-C, in sleep() or wait_for_service()."""
    return any(word in text for _, _, text in direct.lines for word in _ENDED)


def _of(node: Node, direct: Alone, asked: float, shutdown: Shutdown) -> Iterator[Finding]:
    places, since = node.places, asked - _BEFORE
    lines = [text for time, stream, text in direct.lines if stream == "err" and time >= since]
    expected = f"exit code {shutdown.exit_code} within {shutdown.seconds:g} s of {shutdown.signal}"

    def finding(message: str, place: Where, seen: str, fix: str = "") -> Finding:
        return node.finding("exit", message, place, expected=expected, seen=seen, fix=fix)

    code, traceback = direct.code, places.traceback(lines)
    if direct.stopped_in is None:
        if places.waits_in_rospys_end(lines):
            return
        # If roslaunch could end it, and never had to use force, the machine was too busy.
        force = [_needs_force(name, launch) for name, launch in _runs(node)]
        if True in force or False not in force:
            yield finding(
                f"{node.name} doesn't end on Ctrl-C: it was still running after"
                f" {shutdown.seconds:g} s.",
                _loop_around(node, places.stack(lines)) or _waits(node),
                "it keeps running",
                "Let loops end when rospy.is_shutdown() is true or ros::ok() is false, and let no"
                " thread outlive main().",
            )
    elif direct.name is None:
        return  # on a busy machine, it was still starting when it was asked to end
    elif code != shutdown.exit_code and "lock_error" in "\n".join(lines):
        yield finding(*_outlives(node, code), "Let an object in main() own it.")
    elif code != shutdown.exit_code:
        place, why = _cause(node, direct, lines, traceback)
        yield finding(
            f"On {shutdown.signal}, {node.name} ends {code_text(code)}, not with exit code"
            f" {shutdown.exit_code}.{why}",
            place,
            code_text(code),
        )
    elif traceback and not any(words in line for words in _AT_THE_END for line in lines):
        place, kind, text = traceback
        yield finding(f"{node.name} ends with an error: {kind}: {text}", place, f"{kind}: {text}")
    elif direct.still_registered and shutdown.signal == "SIGINT":
        yield finding(
            f"{node.name} ends without telling the master, which still lists it.",
            places.of(node.name, Kind.SIGNAL, Kind.INIT),
            "still registered",
        )


def _outlives(node: Node, code: int | None) -> tuple[str, Where, str]:
    """Return (message, place, what was seen) of an object that is destroyed after ROS itself."""
    # A publisher at file scope does no harm; a timer does.
    globals_ = node.places.facts.of(node.name, Kind.GLOBAL, Kind.OWNER)
    globals_.sort(key=lambda p: "ros::Timer" not in (p.text, *p.holds))
    what, place = "a ROS object", node.places.of(node.name, Kind.TIMER, Kind.HANDLE)
    if globals_:
        what = f"{globals_[0].text} {globals_[0].name}"
        place = globals_[0].file, globals_[0].line
    message = (
        f"{node.name} aborts when it ends: {what}, which lives as long as the program, is destroyed"
        " after ROS itself."
    )
    return message, place, f"{code_text(code)}, boost::lock_error"


def _cause(
    node: Node, direct: Alone, lines: Sequence[str], traceback: Traceback | None
) -> tuple[Where, str]:
    """Return (place, what more to say) of what gives a node another exit code."""
    exits = [event for event in direct.events if event.event == "exit" and event.file]
    if exits:
        return (exits[-1].file, exits[-1].line), ""
    if traceback and direct.code == 1:  # of another thread than main's, it does not set the code
        return traceback[0], f" {traceback[1]}: {traceback[2]}"
    words = last_words(lines)
    place = _leaves(node, direct.code)
    if traceback and direct.code == -signal.SIGINT:  # Python ends so after a KeyboardInterrupt
        place = _loop_around(node, traceback[0]) or place
    return place, f" Its last words: {words}" if words else ""


def _runs(node: Node) -> list[tuple[str, LaunchResult | None]]:
    """Return the name of a node under roslaunch, with what was seen there, of each time it ran."""
    observed = node.places.observed
    own: list[tuple[str, LaunchResult | None]] = [
        (last_part(path), launched.seen)
        for launched in observed.launches
        for path, name in launched.nodes.items()
        if name == node.name
    ]
    return own or [(node.name, observed.launch)]


def _needs_force(name: str, launch: LaunchResult | None) -> bool | None:
    """Return whether roslaunch, too, needed more than Ctrl-C to end a node; None if it did not
    run it."""
    lines = [text for _, _, text in launch.lines] if launch else []
    if not any(re.search(rf"\bprocess\[(\S+/)?{name}-\d+\]: started", text) for text in lines):
        return None
    forced = any(re.search(rf"[\[/]{name}-\d+\] escalating", text) for text in lines)
    return forced or not launch or launch.stopped_in is None


def _waits(node: Node) -> Where:
    """Return the place of what may keep a C++ node from ending: a handler of its own, or a loop."""
    places = node.places.facts.of(node.name, Kind.SIGNAL, Kind.LOOP)
    places.sort(key=lambda place: (place.kind is not Kind.SIGNAL, place.text != "endless"))
    if places:
        return places[0].file, places[0].line
    return node.places.of(node.name, Kind.SPIN, Kind.INIT)


def _loop_around(node: Node, place: Where | None) -> Where | None:
    """Return the place of the loop in which a Python node was: at which of its lines is chance."""
    file, line = place or (None, None)
    source = node.places.facts.python.get(file or "")
    loops = source.nodes(ast.While) if source and line else ()
    around = [loop.lineno for loop in loops if loop.lineno <= (line or 0) <= (loop.end_lineno or 0)]
    return (file, max(around)) if around else place


def _leaves(node: Node, code: int | None) -> Where:
    """Return the place at which a node says its exit code, or changes what Ctrl-C does."""
    exits = node.places.facts.of(node.name, Kind.EXIT)
    if code == -signal.SIGABRT:
        exits = [place for place in exits if place.text == "abort"]
    else:
        exits = [place for place in exits if code and place.value % 256 == code]
    if exits:
        return exits[0].file, exits[0].line
    kinds = (Kind.SIGNAL, Kind.INIT) if code == -signal.SIGINT else (Kind.SPIN, Kind.INIT)
    return node.places.of(node.name, *kinds)


def _leftovers(case: Case) -> Iterator[Finding]:
    seen, spec, places = case.observed, case.spec, case.places
    reported: set[object] = set()
    for left in [process for run in (seen.direct, seen.launch) if run for process in run.left]:
        name = left.node
        if name is None or name not in spec.nodes:
            found = re.search(r"__name:=(\w+)", left.command)
            name = found.group(1) if found and found.group(1) in spec.nodes else None
        alone = seen.alone(name)
        if {(name, "left"), left.command} & reported or alone and alone.killed:
            continue
        reported |= {(name, "left"), left.command}
        starts = places.of(name, Kind.STARTS, Kind.INIT) if name else None
        file, line = starts or places.facts.first(Kind.STARTS)
        name = name or next((node for node in spec.nodes if file in places.sources(node)), None)
        yield Finding(
            "leftovers",
            f"{name or 'The package'} leaves a process behind when it ends: {left.command[:120]}",
            file,
            line,
            expected="no process of the package after its end",
            seen=left.command[:200],
            node=name,
        )


def _findings(case: Case) -> Iterator[Finding]:
    yield from findings(case)
    yield from _leftovers(case)


RULE = Rule(
    stage="stop",
    needs=("nodes",),
    findings=_findings,
    requirements={
        "exit": Requirement(
            "Each node ends cleanly on Ctrl-C",
            "launching",
            evidence.when(Node.has_ended, "wasn't seen to end"),
        ),
        "leftovers": Requirement(
            "Nothing is left when the nodes have ended", "launching", evidence.up
        ),
    },
)
