# SPDX-License-Identifier: BSD-3-Clause
"""No error is raised while the nodes run: by themselves, and under each launch file."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HINT, SEEN, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.run import blame
from mrp_check.run.case import Case
from mrp_check.run.node import Node
from mrp_check.run.observing import Launched
from mrp_check.run.source_lines import Traceback
from mrp_check.run.starting import id_of_error, is_unanswered
from mrp_check.run.words import code_text


def under_launch_files(case: Case) -> Iterator[Finding]:
    """Yield a finding for each node that raises an error, or dies, as others run beside it."""
    for launched in case.observed.launches:
        raised = _raised(case, launched)
        for name, found in raised.items():
            yield _error(case, name, found, launched)
        for name, code in launched.died().items() if launched.file else ():
            if code and name not in raised and not _fails_alone(case.nodes[name]):
                yield _died(case, launched, name, code)


def _fails_alone(node: Node) -> bool:
    """Return whether a node fails by itself, too: rules/run/starts.py says that."""
    return bool(node.not_up) and not (node.direct and node.direct.code == 0)


def _raised(case: Case, launched: Launched) -> dict[str, Traceback]:
    """Return node -> the last error that it raised: what a callback raises, rospy logs for its
    node; the console has what all nodes print."""
    raised: dict[str, Traceback] = {}
    for path, name in launched.nodes.items():
        lines = [line for log in launched.logs(path) for line in log.text.split("\n")]
        found = case.places.traceback(lines)
        called = case.places.wrong_arguments(name, lines)
        if found:
            raised[name] = found
        elif called:
            raised[name] = called[0], "TypeError", called[1]
    found = case.places.traceback(launched.seen.until_asked(0))
    if found:
        file = found[0][0]
        names = [name for name in launched.nodes.values() if file in case.places.sources(name)]
        raised.update({name: found for name in names[:1] if name not in raised})
    # Ctrl-C is no error.
    return {
        name: found
        for name, found in raised.items()
        if found[1] != "KeyboardInterrupt" and not _fails_alone(case.nodes[name])
    }


def _error(case: Case, name: str, found: Traceback, launched: Launched | None = None) -> Finding:
    place, kind, text = found
    where = launched.where if launched else "as it works"
    certainty = HINT if is_unanswered(kind, text) else SEEN
    if not case.spec.is_contract:
        certainty = blame.certainty(case, name, blame.Outcome(kind, text, None, []), launched)
    return Finding(
        id_of_error(kind, text, "callbacks"),
        f"{name} runs into an error {where}: {kind}: {text}",
        *place,
        certainty,
        expected="a node that works without an error",
        seen=f"{kind}: {text}, in: {case.package.line(*place)}",
        node=name,
    )


def _died(case: Case, launched: Launched, name: str, code: int) -> Finding:
    """Return the finding about a node that dies under a launch file, but not by itself."""
    paths = [path for path, node in launched.nodes.items() if node == name]
    logs = [log for path in paths for log in launched.logs(path)]
    errors = [log.text.strip()[:300] for log in logs if log.level in ("ERROR", "FATAL")]
    end = blame.of_lines([*errors, *launched.seen.until_asked()], code)
    alone = "ends without an error" if case.nodes[name].not_up else "keeps running"
    return Finding(
        "starts",
        f"{name} dies {launched.where}, {code_text(code)}; by itself, it {alone}."
        + (f" Its last error: {errors[-1]}" if errors else ""),
        *case.places.of(name, Kind.INIT, Kind.HANDLE),
        blame.certainty(case, name, end, launched),
        expected="a node that runs until Ctrl-C",
        seen=code_text(code),
        fix="" if errors else "Start that launch file, and look at what the node prints last.",
        node=name,
    )


def _findings(case: Case) -> Iterator[Finding]:
    for node in case.nodes.values():
        found = None if node.not_up else case.places.traceback(node.errors())
        called = None
        if not node.not_up and not found:
            called = case.places.wrong_arguments(node.name, node.errors())
        if found:
            yield _error(case, node.name, found)
        elif called:
            yield node.finding(
                "callbacks",
                f"{node.name} has a callback that can't be called as ROS calls it: {called[1]}.",
                called[0],
                expected="a callback that takes one argument, plus self if it is a method",
                seen=f"TypeError: {called[1]}",
            )
    yield from () if case.spec.is_contract else under_launch_files(case)


RULE = Rule(
    "run",
    ("nodes",),
    _findings,
    also=("starts", "callbacks", "python-names", "python-syntax", "type", "node-start"),
)
