# SPDX-License-Identifier: BSD-3-Clause
"""What somebody types is a text in Python 3, and no number; so is an argument of the command line.

In Python 2, input() made a number of it. https://docs.python.org/3/whatsnew/3.0.html#builtins
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import HABIT, READ, Finding
from mrp_check.contract.requirements import Rule

_ORDERS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
_EQUALITIES = (ast.Eq, ast.NotEq)
# A text plus a text, a text times a whole number, and a text % its values are texts.
_NUMERIC = (ast.Sub, ast.Div, ast.FloorDiv, ast.Pow)
_OF_NUMBERS = {"abs", "range", "round", "rospy.Duration", "rospy.Rate", "rospy.sleep"}
_NUMBER = (int, float)


class Typed(PythonRule):
    def findings(self) -> Iterator[Finding]:
        reported: set[ast.expr] = set()
        for node, operand, does in self._uses():
            call = self.typed(operand)
            if call is None or call in reported or self.source.is_guarded(node, "TypeError"):
                continue
            reported.add(call)
            is_equality = isinstance(node, ast.Compare) and isinstance(node.ops[0], _EQUALITIES)
            follows = (
                "they're never equal"
                if is_equality
                else "Python raises a TypeError when it gets there"
            )
            yield self.finding(
                "python-names",
                f"{says(call)}, and line {node.lineno} {does}: {follows}.",
                call,
                certainty=HABIT if is_equality else READ,
                expected=f"float({self.written(call)}), or int(...)",
                fix=f"Write float(...) around {self.written(call)}; or int(...) for whole numbers.",
            )

    def _uses(self) -> Iterator[tuple[ast.expr, ast.expr, str]]:
        """Yield what needs a number: all of it, the part that is one, and what it does with it."""
        for node in self.source.nodes(ast.expr):
            if isinstance(node, ast.Compare) and isinstance(node.ops[0], _ORDERS + _EQUALITIES):
                for side, other in (pair := (node.left, node.comparators[0])), pair[::-1]:
                    if self._is_number(other):
                        yield node, side, "compares it with a number"
            elif isinstance(node, ast.BinOp) and isinstance(node.op, _NUMERIC):
                yield node, node.left, "computes with it"
                yield node, node.right, "computes with it"
            elif isinstance(node, ast.Call) and len(node.args) == 1:
                name = self.source.dotted(node.func) or getattr(node.func, "id", "")
                if name in _OF_NUMBERS and not self.source.definition(node.func):
                    yield node, node.args[0], f"gives it to {name}()"

    def typed(self, node: ast.expr, depth: int = 0) -> ast.expr | None:
        """Return the call of input(), or the part of sys.argv, that an expression is the value of;
        or None."""
        if isinstance(node, ast.Subscript) and self.source.dotted(node.value) == "sys.argv":
            return None if isinstance(node.slice, ast.Slice) else node
        if isinstance(node, ast.Call):
            is_own = "input" in self.source.imports or self.source.definition(node.func)
            is_input = isinstance(node.func, ast.Name) and node.func.id == "input"
            return node if is_input and not is_own else None
        value = self.source.only(node)
        return self.typed(value, depth + 1) if value and depth < 5 else None

    def _is_number(self, node: ast.expr) -> bool:
        """Return whether an expression is a number, as far as the source says it plainly."""
        if isinstance(node, ast.BinOp):
            return isinstance(node.op, (*_NUMERIC, ast.Mult))
        stored = self.source.stored(self.source.key(node))
        values = [self.source.value(given) for given in stored if given is not None] or [
            self.source.value(node)
        ]
        return all(isinstance(value, _NUMBER) for value in values)


def says(typed: ast.expr) -> str:
    """Return in words why something that was typed is no number."""
    is_input = isinstance(typed, ast.Call)
    return "In Python 3, input() returns a string" if is_input else "An argument is a string"


RULE = Rule("static", ("facts",), of_sources(Typed), also=("python-names",))
