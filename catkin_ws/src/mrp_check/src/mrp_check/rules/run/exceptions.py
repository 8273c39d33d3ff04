# SPDX-License-Identifier: BSD-3-Clause
"""No error is raised while the nodes run: by themselves, and under each launch file."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, HINT, SEEN, Finding, Where
from mrp_check.contract.requirements import Rule
from mrp_check.run.case import Case
from mrp_check.run.node import Node, each_node
from mrp_check.run.observing import Launched
from mrp_check.run.places import Traceback
from mrp_check.run.starting import id_of_error, is_unanswered
from mrp_check.run.traces import ends
from mrp_check.run.words import code_text

_GIVES_UP = "RLException: "


def under_launch_files(case: Case) -> Iterator[Finding]:
    for launched in case.observed.launches:
        lines = launched.seen.until_asked()
        yield from _gave_up(case, launched, lines)
        raised = [*_raised(case, launched, launched.seen.until_asked(0))]
        # Nobody but this program runs two ways of writing one node at once.
        is_odd = not launched.file and _has_alternatives(case)
        for one in raised if is_odd else ():
            one.certainty = one.certainty or HABIT
        yield from raised
        waiting = {one.node for one in raised if one.certainty == HINT}
        for path, code in ends(lines).items():
            name = launched.nodes.get(path)
            # What ends by itself, too, has been said.
            if code and name and name not in waiting and not case.nodes[name].not_up:
                finding = _died(case, launched, path, code)
                finding.certainty = HINT if is_odd else finding.certainty
                yield finding


def _has_alternatives(case: Case) -> bool:
    """Return whether two nodes call themselves the same, or serve the same action or service."""
    found: list[tuple[str, str]] = []
    for node, files in case.facts.sources.items():
        said = {(one.kind.value, one.base) for one in case.facts.asked(files)}
        said |= {("is", place.text or node) for place in case.facts.of(node, Kind.INIT)[:1]}
        found += [one for one in said if one[0] in ("is", "offers", "serves")]
    return len(found) > len({*found})


def _raised(case: Case, launched: Launched, lines: list[str]) -> Iterator[Finding]:
    """Yield a finding about the error that each node raised: what a callback raises, rospy logs
    for its node; the console has what all nodes print."""
    seen = launched.seen
    raised = set()
    for path, name in launched.nodes.items():
        logs = (one for one in seen.seen.logs if one.node == path and one.time < seen.asked)
        said = [line for log in logs for line in log.text.split("\n")]
        called = case.places.wrong_arguments(said)
        found = case.places.traceback(said)
        if called and not found:
            found = called[0], "TypeError", called[1]
        if found and name not in raised:
            raised.add(name)
            yield from _error(case, launched, name, found)
    found = case.places.traceback(lines)
    names = [n for n in launched.nodes.values() if found and found[0][0] in case.places.sources(n)]
    if found and names and names[0] not in raised:
        yield from _error(case, launched, names[0], found)


def _error(case: Case, launched: Launched, name: str, found: Traceback) -> Iterator[Finding]:
    place, kind, text = found
    if kind == "KeyboardInterrupt" or case.nodes[name].not_up:
        return  # that is Ctrl-C; or it has been said
    source = case.package.line(place[0], place[1])
    if "sys.argv[" in source and not launched.file:
        said = f"{name} waits for arguments on its command line: {kind}: {text}"
        yield Finding("starts", said, *place, certainty=HINT, node=name)
        return
    yield Finding(
        id_of_error(kind, text, "callbacks"),
        f"{name} runs into an error {launched.where}: {kind}: {text}",
        *place,
        HINT if is_unanswered(kind, text) else "",
        expected="a node that works without an error",
        seen=f"{kind}: {text}, in: {source}",
        node=name,
    )


def _died(case: Case, launched: Launched, path: str, code: int) -> Finding:
    name, seen = launched.nodes[path], launched.seen
    logs = (one for one in seen.seen.logs if one.node == path and one.time < seen.asked)
    said = [one.text.strip()[:300] for one in logs if one.level in ("ERROR", "FATAL")]
    return Finding(
        "starts",
        f"{name} ends {launched.where}, {code_text(code)}; by itself it keeps running."
        + (f" Its last error: {said[-1]}" if said else ""),
        *case.places.of(name, Kind.INIT, Kind.HANDLE),
        expected="a node that runs until Ctrl-C",
        seen=code_text(code),
        node=name,
    )


def _gave_up(case: Case, launched: Launched, lines: list[str]) -> Iterator[Finding]:
    """Yield a note if roslaunch ends by itself: it most often wants what is not on this machine."""
    said = next((text for text in lines if text.startswith(_GIVES_UP)), None)
    if launched.seen.ending != "itself" or said is None:
        return
    place: Where = (launched.file, 1) if launched.file else (None, None)
    what = launched.file or "all nodes together"
    yield Finding(
        "starts",
        f"roslaunch gives up on {what}: {said[len(_GIVES_UP) :][:300]}",
        *place,
        certainty=HINT,
        expected="a launch file that runs until Ctrl-C",
        seen=said[:300],
    )


def _raises(node: Node) -> Iterator[Finding]:
    if node.not_up:
        return
    found = node.places.traceback(node.errors())
    if found:
        place, kind, text = found
        source = node.package.line(place[0], place[1])
        yield node.finding(
            id_of_error(kind, text, "callbacks"),
            f"{node.name} runs into an error as it works: {kind}: {text}",
            place,
            HINT if is_unanswered(kind, text) else SEEN,
            expected="a node that works without an error",
            seen=f"{kind}: {text}, in: {source}",
        )
        return
    called = node.places.wrong_arguments(node.errors())
    if called:
        place, text = called
        yield node.finding(
            "callbacks",
            f"{node.name} has a callback that can't be called as ROS calls it: {text}.",
            place,
            expected="a callback that takes one argument, plus self if it is a method",
            seen=f"TypeError: {text}",
        )


def _findings(case: Case) -> Iterator[Finding]:
    yield from each_node(_raises, also_dead=True)(case)
    yield from () if case.spec.is_contract else under_launch_files(case)


RULE = Rule(
    "run",
    ("nodes",),
    _findings,
    also=("starts", "callbacks", "python-names", "python-syntax", "type", "node-start"),
)
