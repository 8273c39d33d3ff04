# SPDX-License-Identifier: BSD-3-Clause
"""What a call returns that can fail is looked at: a client goes on as if a server had answered.

https://docs.ros.org/en/noetic/api/roscpp/html/classros_1_1ServiceClient.html
https://docs.ros.org/en/noetic/api/actionlib/html/classactionlib_1_1SimpleActionClient.html
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import in_both
from mrp_check.code.in_both import OfNode
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of

# A whole statement that is such a call; its arguments.
_STATEMENT = r"(?<=[;{{}})])\s*(?:\w+(?:\.|->)|ros::service::)({0})\s*\(([^;]*)\)\s*;"
_WAITS = re.compile(
    _STATEMENT.format("waitForServer|waitForResult|waitForExistence|waitForService")
)
_CLIENT = re.compile(
    r"\bServiceClient\s+(\w+)|\b(\w+)\s*=\s*\w+(?:\.|->)serviceClient\b|\b(\w+)\(\w+\.serviceClient\b"
)
_STATE = r"\b(?:getState|get_state)\b"  # it says what came of the wait
_PYTHON_WAITS = ("wait_for_server", "wait_for_result")


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        yield from _of_python(one) if one.python else [*_waits(one), *_calls(one)]


def _waits(one: OfNode) -> Iterator[Finding]:
    for match in _WAITS.finditer(one.code):
        name, given = match.groups()
        # waitForService() has the service's name first.
        is_limited = bool(given.partition(",")[2] if name == "waitForService" else given.strip())
        if "Result" not in name or not re.search(_STATE, one.code[match.end() :]):
            yield _goes_on(one, name, line_of(match, 1), is_limited)
            return


def _goes_on(one: OfNode, name: str, line: int, is_limited: bool) -> Finding:
    when = "when the time is over, or on Ctrl-C" if is_limited else "on Ctrl-C"
    return one.finding(
        "starts",
        f"{name}() returns false {when}, and {one.node} does not look at it: it goes on as if what"
        " it waits for had come.",
        line,
        expected=f"if (!{name}(...))" if one.code else f"if not ...{name}(...):",
        fix="Look at what it returns: say what is missing, and leave.",
        certainty=HABIT if is_limited else HINT,
    )


def _calls(one: OfNode) -> Iterator[Finding]:
    clients = {name for match in _CLIENT.finditer(one.code) for name in match.groups() if name}
    for name in sorted(clients):
        shape = rf"(?<=[;{{}})])\s*{name}\s*\.\s*(call)\s*\([^;]*\)\s*;"
        match = re.search(shape, one.code)
        if match:
            yield one.finding(
                "starts",
                f"{name}.call() returns false if nobody offers the service, or it fails, and"
                f" {one.node} does not look at it: it goes on with an empty response.",
                line_of(match, 1),
                expected=f"if ({name}.call(...))",
                fix="Look at what it returns, and say so if the call failed.",
            )


def _of_python(one: OfNode) -> Iterator[Finding]:
    assert one.python
    asks = {node.attr for node in one.python.nodes(ast.Attribute)}
    for statement in one.python.nodes(ast.Expr):
        call = statement.value
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
            name, is_limited = call.func.attr, bool(call.args or call.keywords)
            is_seen = name == "wait_for_result" and "get_state" in asks
            if name in _PYTHON_WAITS and is_limited and not is_seen:
                yield _goes_on(one, name, call.lineno, is_limited)
                return


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
