# SPDX-License-Identifier: BSD-3-Clause
"""How many values a message has is looked at before one of them is read: its sender says how many.

https://wiki.ros.org/msg#Array_Handling
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both
from mrp_check.sources.in_both import OfNode

# The arrays of any length in ROS's own messages that nodes read by number: LaserScan, JointState,
# those of std_msgs, Path and PoseArray. A joystick has as many axes and buttons as it has.
_FIELDS = ("ranges", "intensities", "effort", "velocity", "position", "data", "poses", "dim")
_READ = re.compile(
    rf"\b(\w+)\s*(?:->|\.)\s*(?:layout\s*\.\s*)?({'|'.join(_FIELDS)})\s*\[\s*(\d+)\s*\](?!\s*=(?!=))"
)
# A callback that is given a message, in C++.
_GIVEN = r"\b(?:ConstPtr\s*&?|Ptr\s*&?|const\s*&|&)\s*{0}\s*\)"


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        yield from _of_python(one) if one.python else _of_cpp(one)


def _of_cpp(one: OfNode) -> Iterator[Finding]:
    for match in _READ.finditer(one.code):
        name, field, number = match.groups()
        is_counted = rf"\b{field}\s*\.\s*(?:size|empty|at|begin)\b"
        if re.search(_GIVEN.format(name), one.code) and not re.search(is_counted, one.code):
            yield _finding(one, f"{name}.{field}[{number}]", line_of(match), "is what lies there")
            return


def _of_python(one: OfNode) -> Iterator[Finding]:
    source = one.python
    assert source
    counted = {
        argument.attr
        for call in source.nodes(ast.Call)
        if isinstance(call.func, ast.Name) and call.func.id in ("len", "enumerate")
        for argument in call.args
        if isinstance(argument, ast.Attribute)
    }
    for node in source.nodes(ast.Subscript):
        of, number = node.value, source.value(node.slice)
        if not isinstance(of, ast.Attribute) or not isinstance(of.value, ast.Name):
            continue
        around = [getattr(one, "args", None) for one in source.above(node)]
        given = {
            one.arg
            for arguments in around
            if isinstance(arguments, ast.arguments)
            for one in arguments.args
        } - {"self"}
        is_read = isinstance(node.ctx, ast.Load) and isinstance(number, int)
        is_caught = source.is_guarded(node, "IndexError") or of.attr in counted
        if is_read and of.attr in _FIELDS and of.value.id in given and not is_caught:
            text = f"{of.value.id}.{of.attr}[{number}]"
            yield _finding(one, text, node.lineno, "raises an IndexError")
            return


def _finding(one: OfNode, read: str, line: int, what: str) -> Finding:
    return one.finding(
        "callbacks",
        f"{one.node} reads {read}, and does not look how many values the message has: of one that"
        f" has fewer, this {what}.",
        line,
        expected="a look at its length first",
        fix="Compare the length with what is read, and leave the message out if it is too short.",
    )


RULE = Rule("static", 117, ("facts",), _findings, also=("callbacks",), only=ANY)
