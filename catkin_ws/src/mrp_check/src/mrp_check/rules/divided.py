# SPDX-License-Identifier: BSD-3-Clause
"""A service checks that what it divides by is not 0: a client may send any number."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_source import Source
from mrp_check.student.package import Package

_OFFERED = re.compile(
    r"\bbool\s+[\w:]+\s*\(\s*(?:const\s+)?(?:\w+::)*?(\w+?)(?:::)?Request\s*&\s*(\w+)[^)]*\)\s*(?=\{)"
)
_RAISES = "this ends the call with a ZeroDivisionError"
_DIVISIONS = (ast.Div, ast.FloorDiv, ast.Mod)


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        found = _in_python(one.python) if one.python else _in_cpp(one.package, one.code)
        dies = _RAISES if one.python else "the program dies of it"
        for field, line in found:
            yield one.finding(
                "callbacks",
                f"Nobody looks whether {field} of the request is 0: then {dies}.",
                line,
                expected=f"a condition on {field} before this line",
                fix=f"Answer a request whose {field} is 0 in another way.",
            )


def _in_cpp(package: Package, text: str) -> Iterator[tuple[str, int]]:
    """Yield (field, line) of each division of a service by a whole number that is not asked."""
    for offered in _OFFERED.finditer(text):
        kind, request = offered.groups()
        body = braced(text, offered.end())
        shape = re.compile(rf"[/%]=?\s*{request}\.(\w+)\b")
        for division in shape.finditer(text, offered.end(), offered.end() + len(body)):
            field = division[1]
            asked = rf"{request}\.{field}\s*[!=<>]|[!<>=]\s*{request}\.{field}\b"
            before = text[offered.end() : division.start()]
            if _is_whole(package, kind, field) and not re.search(asked, before):
                yield field, line_of(division)


def _is_whole(package: Package, service: str, field: str) -> bool:
    """Return whether a field of a service of this package's own is a whole number."""
    paths = [path for path in package.of_kind("service") if path.endswith(f"/{service}.srv")]
    shape = rf"^\s*u?int\d+\s+{field}\b"
    return any(re.search(shape, package.text(path), re.MULTILINE) for path in paths)


def _in_python(source: Source) -> Iterator[tuple[str, int]]:
    """Yield (field, line) of each division of a service by what is not asked."""
    for call in source.nodes(ast.Call):
        offers = source.dotted(call.func) == "rospy.Service"
        answer = source.definition(argument(call, 2, "handler")) if offers else None
        if not isinstance(answer, ast.FunctionDef) or not answer.args.args:
            continue
        request = answer.args.args[-1].arg
        tests = [one.test for one in ast.walk(answer) if isinstance(one, (ast.If, ast.IfExp))]
        asked = [
            (_field(source, node, request), test.lineno)
            for test in tests
            for node in ast.walk(test)
        ]
        for node in ast.walk(answer):
            if isinstance(node, ast.BinOp) and isinstance(node.op, _DIVISIONS):
                field = _field(source, node.right, request)
                if field and not any(one == field and line <= node.lineno for one, line in asked):
                    if not source.is_guarded(node, "ZeroDivisionError", "ArithmeticError"):
                        yield field, node.lineno


def _field(source: Source, node: ast.AST, request: str) -> str | None:
    """Return the field of the request that an expression is, or None."""
    if isinstance(node, ast.Name):
        node = source.only(node) or node
    is_field = isinstance(node, ast.Attribute) and getattr(node.value, "id", "") == request
    return node.attr if is_field and isinstance(node, ast.Attribute) else None


RULE = Rule("static", 98, ("facts",), _findings, also=("callbacks",), only=ANY)
