# SPDX-License-Identifier: BSD-3-Clause
"""An action server is started, and looks whether its goal has been cancelled.

https://wiki.ros.org/actionlib/DetailedDescription; of auto_start=True, both libraries warn.
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_source import Source
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import CERTAIN, HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case

_ASKS = {"is_preempt_requested", "set_preempted"}
_LASTING = {"sleep", "publish_feedback"}
_NEVER = (
    "The action server is created with auto_start=False, but nothing calls its start(), so no"
    " goal ever reaches it.",
    "Call start() on it.",
)
_CANCELLED = (
    "This loop doesn't check whether its goal has been cancelled, so it keeps running.",
    "Check {0} in each turn, and end the goal as preempted.",
)


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        found = [
            (p.file, p.line, _CANCELLED, "isPreemptRequested()")
            for p in case.facts.of(node, Kind.GOAL_LOOP)
        ]
        sources = [*filter(None, map(case.facts.python.get, files))]
        named = set().union(*(_attributes(source.tree) for source in sources))
        for source in sources:
            found += [(source.file, *one) for one in _in_python(source, named)]
        for file, line, what, wanted in found:
            message, fix = what
            seen = case.package.line(file, line)
            at = file, line, CERTAIN if what is _NEVER else HABIT
            yield Finding("callbacks", message, *at, wanted, seen, fix.format(wanted), node=node)


def _in_python(source: Source, named: set[str]) -> Iterator[tuple[int, tuple[str, str], str]]:
    """Yield (line, what is wrong and what to do, what is wanted) of each server.

    named: the attributes in all sources of its node
    """
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) != "actionlib.SimpleActionServer":
            continue
        at_once = argument(call, 3, "auto_start")
        if at_once and source.value(at_once) is False and "start" not in named:
            yield call.lineno, _NEVER, "start(), once everything else is set up"
        work = source.definition(argument(call, 2, "execute_cb"))
        if isinstance(work, ast.FunctionDef) and not _ASKS & named:
            loops = (node for node in ast.walk(work) if isinstance(node, (ast.For, ast.While)))
            lasting = [one.lineno for one in loops if _LASTING & _attributes(one)]
            if lasting:
                yield lasting[0], _CANCELLED, "is_preempt_requested()"


def _attributes(within: ast.AST) -> set[str]:
    return {node.attr for node in ast.walk(within) if isinstance(node, ast.Attribute)}


RULE = Rule("static", ("facts",), _findings, also=("callbacks",), only=ANY)
