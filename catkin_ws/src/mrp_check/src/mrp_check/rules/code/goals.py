# SPDX-License-Identifier: BSD-3-Clause
"""An action server looks whether its goal has been cancelled.

https://wiki.ros.org/actionlib/DetailedDescription
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_source import Source
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case

_ASKS = {"is_preempt_requested", "set_preempted"}
_LASTING = {"sleep", "publish_feedback"}


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        places = case.facts.of(node, Kind.GOAL_LOOP)
        found = [(place.file, place.line, "isPreemptRequested()") for place in places]
        sources = [*filter(None, map(case.facts.python.get, files))]
        named = set().union(*(_attributes(source.tree) for source in sources))
        for source in sources if not _ASKS & named else ():
            found += [(source.file, line, "is_preempt_requested()") for line in _loops(source)]
        for file, line, wanted in found:
            yield Finding(
                "callbacks",
                "This loop doesn't check whether its goal has been cancelled, so it keeps running.",
                file,
                line,
                HABIT,
                wanted,
                case.package.line(file, line),
                f"Check {wanted} in each turn, and end the goal as preempted.",
                node=node,
            )


def _loops(source: Source) -> Iterator[int]:
    """Yield the line of the first loop that lasts, of each server's callback."""
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) != "actionlib.SimpleActionServer":
            continue
        work = source.definition(argument(call, 2, "execute_cb"))
        if isinstance(work, ast.FunctionDef):
            loops = (node for node in ast.walk(work) if isinstance(node, (ast.For, ast.While)))
            yield from [loop.lineno for loop in loops if _LASTING & _attributes(loop)][:1]


def _attributes(within: ast.AST) -> set[str]:
    return {node.attr for node in ast.walk(within) if isinstance(node, ast.Attribute)}


RULE = Rule("static", ("facts",), _findings, also=("callbacks",), only=ANY)
