# SPDX-License-Identifier: BSD-3-Clause
"""The console shows the right lines."""

from __future__ import annotations

import difflib
import re
from typing import Iterator, Sequence

from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Log
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.console_lines import not_logged, other_words, sample
from mrp_check.run.node import Node, each_node
from mrp_check.run.words import PREFIX

_NEAR = 0.6  # how alike two lines are, from 0 to 1, to call one of them a misspelling
_FLOOD = 2000  # lines that a node prints in its few seconds


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding for each line that the node should log otherwise, or prints too many."""
    printed = node.direct.line_count if node.direct else 0
    if printed > _FLOOD:
        yield node.finding(
            "console",
            f"{node.name} floods the console: it printed {printed} lines in a few seconds.",
            node.places.of(node.name, Kind.PRINT, Kind.LOG),
            expected="the contract's lines, and few others",
            seen=f"{printed} lines",
        )
    for line in node.wanted.prints:
        if "{value}" in line and node.wanted.subscribes:
            yield from _level_findings(node, line)
            continue
        yield from _line_findings(node, line)


def _runs_of(node: Node) -> Iterator[tuple[str, Sequence[Log], Sequence[str]]]:
    """Return (full name, logs, lines of the console), by the launch file and by itself."""
    if node.in_launch:
        yield node.path, node.seen.logs, node.console
    if node.direct and node.own_name:
        lines = [text for _, _, text in node.direct.lines]
        yield node.own_name, node.seen_alone.logs, lines


def _line_findings(node: Node, line: str) -> Iterator[Finding]:
    wanted_of = node.wanted.pattern
    runs = [(path, logs, lines, wanted_of(line, path)) for path, logs, lines in _runs_of(node)]
    if not runs:
        return
    good = [log for path, logs, _, pattern in runs for log in logs if pattern.fullmatch(log.text)]
    path, logs, lines, pattern = runs[0]
    wanted = sample(line, "...", path)
    if good:
        yield from _level_finding(node, good[0], wanted)
        return
    if any(_is_logged(text, p) for _, _, texts, p in runs for text in texts):
        return  # on a busy machine, a node's very first line can miss /rosout
    printed = [t for t in lines if pattern.search(t) and not PREFIX.match(t)]
    if printed:
        yield not_logged(node, printed[0], wanted)
        return
    near = _nearest(node, wanted, logs)
    if near:
        if near.text not in node.wrong_texts():  # else it has been said: it logs what it publishes
            yield other_words(node, near, wanted, _name_hint(near.text, wanted, path))
        return
    shown = [t for t in lines if _ratio(t, wanted) > 0.8 and not PREFIX.match(t)]
    yield node.finding(
        "console",
        f"{node.name} doesn't log the line “{wanted}”."
        + (f" It prints “{shown[0]}”." if shown else ""),
        node.places.of(node.name, Kind.PRINT if shown else Kind.LOG, Kind.INIT),
        expected=wanted,
        seen=shown[0] if shown else "no such line",
    )


def _name_hint(text: str, wanted: str, path: str) -> str:
    """Say how to get a node's full name, if that alone is wrong."""
    group = path.rsplit("/", 1)[0]
    start = wanted[: -len(path)] if wanted.endswith(path) else None
    if start is None or text not in (start + group, start + group + "/"):
        return ""
    return (
        "That's only the group's name. The node's full name is rospy.get_name() in Python, and"
        ' ros::NodeHandle("~").getNamespace() in C++.'
    )


def _nearest(node: Node, wanted: str, logs: Sequence[Log]) -> Log | None:
    others = [node.wanted.pattern(line) for line in node.wanted.prints]
    taken = [log for log in logs if any(p.fullmatch(log.text) for p in others)]
    rest = [log for log in logs if log not in taken or _ratio(log.text, wanted) > _NEAR]
    best = max(rest, key=lambda log: _ratio(log.text, wanted), default=None)
    return best if best and _ratio(best.text, wanted) > _NEAR else None


def _level_findings(node: Node, line: str) -> Iterator[Finding]:
    """The line of a received value: is it a whole line, and of the right level?"""
    pattern = node.wanted.pattern(line)
    logs = [log for log in node.seen.logs + node.seen_alone.logs if pattern.search(log.text)]
    if not logs:
        return
    log, found = logs[0], pattern.search(logs[0].text)
    wanted = sample(line, found["value"] if found else "...")
    if not pattern.fullmatch(log.text):
        yield other_words(node, log, wanted)
    else:
        yield from _level_finding(node, log, wanted)


def _level_finding(node: Node, log: Log, wanted: str) -> Iterator[Finding]:
    if log.level != "INFO":
        yield node.finding(
            "console",
            f"{node.name} logs “{log.text}” as {log.level}, not as INFO.",
            node.places.of_log(node.name, log),
            expected=f"[INFO] [time]: {wanted}",
            seen=f"[{log.level}] [time]: {log.text}",
        )


def _is_logged(text: str, pattern: re.Pattern[str]) -> bool:
    """Return whether a line of the console is what the pattern says, logged as INFO."""
    prefix = PREFIX.match(text)
    return bool(prefix and prefix["level"] == "INFO" and pattern.fullmatch(text[prefix.end() :]))


def _ratio(a: str, b: str) -> float:
    return difflib.SequenceMatcher(None, a, b, autojunk=False).ratio()


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "console": Requirement("The console shows the right lines", "launching", evidence.up)
    },
    only=CONTRACT,
)
