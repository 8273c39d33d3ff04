# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong behind the first fault of a source that Python cannot read: a name that rospy has
not, and a publisher without a queue."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of, nearest, perhaps
from mrp_check.rules.queue import NO_QUEUE
from mrp_check.sources import uses
from mrp_check.sources.python_modules import resolve

_PUBLISHER = re.compile(r"\brospy\.Publisher\s*(?=\()")
_WITH_QUEUE = 6  # commas: queue_size is the seventh
_NAMED = re.compile(r"\brospy\.(\w+)")


def _findings(case: Case) -> Iterator[Finding]:
    everything, missing = resolve("rospy")
    for node, files in case.facts.sources.items():
        for file in sorted(case.facts.unread & {*files}):
            yield from _no_queue(case, node, file)
        unread = case.facts.unread - {*case.facts.python} if missing is None else set()
        for file in unread & {*files}:
            for match in _NAMED.finditer(uses.code(case.package, file)):
                name, line = match[1], line_of(match)
                if not hasattr(everything, name) and case.package.kind(file) == "python":
                    near = nearest(name, dir(everything))
                    yield Finding(
                        "python-names",
                        f"rospy has nothing of the name {name}.{perhaps(near)}",
                        file,
                        line,
                        WARNING,
                        expected=f"rospy.{near}" if near else "what rospy has",
                        seen=case.package.line(file, line),
                        fix=f"Write rospy.{near}." if near else "Look it up in rospy's pages.",
                        node=node,
                    )


def _no_queue(case: Case, node: str, file: str) -> Iterator[Finding]:
    text = uses.code(case.package, file) if case.package.kind(file) == "python" else ""
    for match in _PUBLISHER.finditer(text):
        given, line = braced(text, match.end(), "()"), line_of(match)
        if "queue_size" not in given and "**" not in given and given.count(",") < _WITH_QUEUE:
            yield Finding(
                "warnings",
                NO_QUEUE,
                file,
                line,
                WARNING,
                expected="queue_size=10, or whatever the topic needs",
                seen=case.package.line(file, line),
                fix="Add queue_size=10.",
                node=node,
                why="queue-size-missing",
            )


RULE = Rule("static", 104, ("facts",), _findings, also=("python-names", "warnings"), only=ANY)
