# SPDX-License-Identifier: BSD-3-Clause
"""ROS's own libraries log no warning and no error while the nodes run.

What a node logs itself is its author's business: it is counted, and shown as a note.
"""

from __future__ import annotations

import ast
import re
from typing import Iterator, NamedTuple

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Log
from mrp_check.contract.finding import HABIT, HINT, SEEN, Finding, Where
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence, logged
from mrp_check.run.case import Case
from mrp_check.run.logged import Run
from mrp_check.run.node import Node

_LEVELS = ("WARN", "ERROR", "FATAL")
_NOT_A_NAME = re.compile(r"'(?P<name>[^']*)' is not a legal ROS")
_FILE = re.compile(r'File "(?P<path>[^"]+)", line (?P<line>\d+)')


class _Known(NamedTuple):
    """A line that a library logs where a node is wrong for certain.

    says: a part of the line; id: the requirement; means: what the node does; fix: what to do
    near: the kind of the place in the source that it is about
    """

    says: str
    id: str
    means: str
    fix: str
    near: Kind


_KNOWN = (
    _Known(
        "did not set the goal to a terminal status",
        "callbacks",
        "returns from its execute callback without ending the goal: actionlib aborts it",
        "Call set_succeeded(), set_aborted() or set_preempted() on each path through the callback.",
        Kind.SERVES,
    ),
    _Known(
        "To transition to a",
        "callbacks",
        "ends a goal that has ended already",
        "Return from the callback right after the call that ends the goal.",
        Kind.ENDS,
    ),
    _Known(
        "Error processing request",
        "callbacks",
        "raises an error while it answers a service",
        "Correct the line that raises it.",
        Kind.OFFERS,
    ),
)
# What is no fault of the package, and why not.
_RACES = {
    "Got a transition callback on a goal handle that we're not tracking": (
        "the server may answer before send_goal() has returned: ros/actionlib, issue 206"
    ),
    "Inbound TCP/IP connection failed": "the other node, or the observer, ended at this moment",
    "Failed to handle inbound connection due to socket error": "the same",
    "Unable to immediately register with master": "on a busy machine, the master answers late",
    "ailed to contact": "the same; or the node that offers the service is about to end",
}
# Another rule says more of these, or of what they lead to.
_OF_OTHERS = {
    "topic types do not match": "meeting",
    "to have datatype/md5sum": "meeting",
    "bad callback": "raised and launched",
    "Exception in your execute callback": "raised and launched",
}
# What tf2 says of a transform that it cannot look up: the nodes log it themselves.
_FRAMES = re.compile(
    r"passed to lookupTransform argument \w+ does not exist|Could not find a connection between"
    r"|not part of the same tree|Lookup would require extrapolation"
)
_FRAME = re.compile(r"['\"]/?([\w/]+)['\"]")
_OFTEN, _LATE = 5, 1.0  # look-ups that fail; seconds before the end in which one still does


def _findings(case: Case) -> Iterator[Finding]:
    reported: set[tuple[str, str]] = set()
    own: dict[str, list[Log]] = {}
    for node in case.nodes.values():
        if node.is_up:
            yield from _illegal_name(node)
    for run in logged.runs(case.observed):
        if run.node not in case.nodes:
            continue
        lines = [log for log in run.logs if log.level in _LEVELS]
        node = case.nodes[run.node]
        for finding in (*_of_libraries(node, run, lines), *_of_rotations(node, run)):
            if (run.node, finding.seen) not in reported:
                reported.add((run.node, finding.seen))
                yield finding
        frames = [log for log in lines if _FRAMES.search(log.text)]
        yield from _of_frames(node, run, frames)
        of_node = [log for log in lines if logged.is_own(case.package, log) and log not in frames]
        own[run.node] = max(own.get(run.node, []), of_node, key=len)
    for name, lines in own.items():
        if lines:
            yield case.nodes[name].finding(
                "warnings",
                f"{name} logs {len(lines)} warnings or errors of its own, such as:"
                f" {lines[0].text.strip()[:200]}",
                case.places.of_log(name, lines[0]),
                HINT,
            )


def _of_libraries(node: Node, run: Run, lines: list[Log]) -> Iterator[Finding]:
    """Yield a finding for each kind of line that a library has logged in a run of a node."""
    for log in lines:
        text = log.text.strip().split("\n")[0]
        skipped = any(part in text for part in (*_RACES, *_OF_OTHERS))
        if skipped or logged.is_own(node.package, log) or _FRAMES.search(text):
            continue
        known = next((warning for warning in _KNOWN if warning.says in text), None)
        why = logged.answer(text)
        if known:
            message = f"{node.name} {known.means}, {run.where}. ROS says: {text[:300]}"
            place = _place(node, log, known.near)
            yield node.finding(
                known.id,
                message,
                place,
                expected="no such line",
                seen=known.says,
                fix=known.fix,
                why=why,
            )
        else:
            message = f"A ROS library logs this for {node.name}, {run.where}: {text[:300]}"
            seen = f"{log.file}:{log.line}"
            place = _place(node, log)
            more = {"expected": "no such line", "seen": seen, "why": why}
            yield node.finding("warnings", message, place, HABIT, **more)


def _place(node: Node, log: Log, *near: Kind) -> Where:
    """Return the last line of the package's own in a traceback, or a place of these kinds."""
    own = [(node.places.own(hit["path"]), int(hit["line"])) for hit in _FILE.finditer(log.text)]
    places = [(file, line) for file, line in own if file]
    return places[-1] if places else node.places.of(node.name, *near, Kind.INIT, Kind.HANDLE)


def _of_frames(node: Node, run: Run, failed: list[Log]) -> Iterator[Finding]:
    """Yield a finding if tf2 fails to look up a transform to the end of a run."""
    if len(failed) < _OFTEN or failed[-1].time < run.asked - _LATE:
        return
    published: set[str] = set()
    for message in run.seen.messages:
        published |= {*str((message.fields or {}).get("frames", "")).split()}
    if not published:
        return  # who sends them is not in this package
    text = failed[-1].text.strip()
    names = {*_FRAME.findall(text)}
    if names and names <= published:
        detail = "though both are published. A new tf2 buffer is empty, and needs a listener"
        certainty, fix = SEEN, "Make one tf2 Buffer and one TransformListener, before the loop."
    else:
        detail = f"to the end of the run. Published are: {', '.join(sorted(published))}"
        certainty, fix = HABIT, "Compare the names of the frames, and wait until they are there."
    yield node.finding(
        "warnings",
        f"{node.name} can't look up a transform, {run.where}, {detail}: {text[:200]}",
        node.places.of_log(node.name, failed[-1]),
        certainty,
        expected="a transform that is found after a moment",
        seen=f"{len(failed)} such lines",
        fix=fix,
        why=logged.answer(text),
    )


def _of_rotations(node: Node, run: Run) -> Iterator[Finding]:
    """Yield a finding if a node sends a transform that tf2 ignores."""
    sent = (message.fields or {} for message in run.seen.messages if message.node == run.path)
    frame = next((fields["bad_rotation"] for fields in sent if fields.get("bad_rotation")), None)
    if frame:
        yield node.finding(
            "warnings",
            f"{node.name} sends a transform to {frame}, {run.where}, whose rotation isn't a"
            " quaternion of length 1: tf2 ignores it.",
            node.places.of(node.name, Kind.INIT, Kind.HANDLE),
            SEEN,
            expected="a rotation, such as w = 1 for none",
            seen=f"a rotation of another length, to {frame}",
            fix="Set transform.rotation, by setRPY() or quaternion_from_euler() for example.",
        )


def _illegal_name(node: Node) -> Iterator[Finding]:
    """Yield a Finding if rospy has warned of a name."""
    for text in node.errors():
        found = _NOT_A_NAME.search(text)
        if found:
            name = found["name"]
            kind = Kind.PUBLISHER if node.wanted.publishing else Kind.SUBSCRIBER
            file, line = node.places.of_topic(node.name, kind, name)
            source = node.places.facts.python.get(file or "")
            if "//" in name and source:  # where it is put together
                calls = source.nodes(ast.Call)
                joins = (c.lineno for c in calls if source.dotted(c.func) == "rospy.get_namespace")
                line = next(joins, line)
            slashes = " It has two slashes: rospy.get_namespace() already ends with one."
            yield node.finding(
                "warnings",
                f"{node.name} uses the name '{name}', which ROS warns about."
                + (slashes if "//" in name else ""),
                (file, line),
                HABIT,
                expected=name.replace("//", "/"),
                seen=name,
                why="e09-double-slash",
            )
            return


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=_findings,
    requirements={
        "warnings": Requirement(
            "ROS's own libraries log no warnings and no errors", "wrong", evidence.alone
        )
    },
    also=("callbacks",),
)
