# SPDX-License-Identifier: BSD-3-Clause
"""Each way to a line gives what it reads a value: no condition and no error leaves it out."""

from __future__ import annotations

import ast
from typing import Iterator, Sequence

from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.code.python_source import Variable
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Rule

_LEAVES = (ast.Break, ast.Continue, ast.Raise, ast.Return)
_EXITS = {"exit", "quit", "sys.exit", "os._exit"}
# Errors that come when the node is to end.
_OF_END = {"KeyboardInterrupt", "ROSInterruptException", "SystemExit"}
_LOOPS = (ast.For, ast.While)
# Of the last condition of several: they may be all that there are.
_ORDERS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
# What stands within it is read only at times, or at another time.
_AT_TIMES = (ast.BoolOp, ast.GeneratorExp, ast.IfExp, ast.Lambda, ast.ListComp)


class Unbound(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in ast.walk(self.source.tree):
            for name in ("body", "orelse", "finalbody"):
                block = getattr(node, name, None)
                if isinstance(block, list):  # that of a lambda is none
                    yield from self._of(block)

    def _of(self, block: Sequence[ast.stmt]) -> Iterator[Finding]:
        for number, one in enumerate(block):
            if isinstance(one, (ast.If, ast.Try)) and not self._is_repeated(one):
                yield from self._after(one, block[number + 1 :])

    def _is_repeated(self, statement: ast.stmt) -> bool:
        """Return whether a loop does it: an earlier turn may have given what this one does not."""
        function = self.source.function(statement)
        loops = (one for one in self.source.above(statement) if isinstance(one, _LOOPS))
        return any(self.source.function(loop) is function for loop in loops)

    def _after(self, branches: ast.If | ast.Try, rest: Sequence[ast.stmt]) -> Iterator[Finding]:
        """Yield a Finding about the first read after branches of which not each gives a value."""
        for key in {key for node in _names(branches, ast.Store) if (key := self.source.key(node))}:
            reads = (node for one in rest for node in self._read(one))
            read = next((node for node in reads if self.source.key(node) == key), None)
            if not read or not self._is_set_in(key, branches) or self._binds([branches], key):
                continue
            is_try, line = isinstance(branches, ast.Try), branches.lineno
            why = f"an error ends what line {line} tries" if is_try else f"line {line} is not true"
            if not is_try and branches.orelse:
                why = f"no condition from line {line} on is true"
            in_function = self.source.function(read) is not self.source.tree
            yield self.finding(
                "python-names",
                f"{read.id} has no value if {why}: then Python ends with"
                f" {'an UnboundLocalError' if in_function else 'a NameError'} when it comes here.",
                read,
                certainty=HABIT,
                expected=f"a value of {read.id} in each case",
                fix=f"Give {read.id} a value before line {line}; or leave in that case.",
            )

    def _is_set_in(self, key: Variable, statement: ast.stmt) -> bool:
        """Return whether a variable of the function of a statement is set within that alone."""
        inside = [n for n in _names(statement, ast.Store) if self.source.key(n) == key]
        is_own = key[0] is self.source.function(statement) and key[1] not in self.source.imports
        return is_own and len(self.source.stored(key)) == len(inside)

    def _binds(self, block: Sequence[ast.stmt], key: Variable) -> bool:
        """Return whether each way through a block gives a variable a value, or leaves."""
        for one in block:
            if isinstance(one, _LEAVES) or self._exits(one):
                return True
            ways = [[one]]
            if isinstance(one, ast.If):
                ways = [one.body, one.orelse]
                above = self._if_above(one)
                if not one.orelse and _is_order(one.test) and above and not _skip_equal(above, one):
                    ways.pop()
            elif isinstance(one, ast.Try):
                early = [] if self._gives_plainly(one.body[0], key) else one.handlers
                late = [handler.body for handler in early if not _is_of_end(handler)]
                ways = [[*one.body, *one.orelse], *late]
                if self._binds(one.finalbody, key):
                    return True
            elif any(self.source.key(node) == key for node in _names(one, ast.Store)):
                return True  # a loop is believed to be done
            else:
                continue
            if all(self._binds(way, key) for way in ways):
                return True
        return False

    def _if_above(self, statement: ast.If) -> ast.If | None:
        """Return the condition whose elif a statement is, or None."""
        above = self.source.parents.get(statement)
        return above if isinstance(above, ast.If) and above.orelse == [statement] else None

    def _gives_plainly(self, statement: ast.stmt, key: Variable) -> bool:
        """Return whether a statement gives a value to a variable, and nothing in it can fail."""
        is_given = any(self.source.key(node) == key for node in _names(statement, ast.Store))
        return is_given and not any(isinstance(n, ast.Call) for n in ast.walk(statement))

    def _exits(self, statement: ast.stmt) -> bool:
        call = statement.value if isinstance(statement, ast.Expr) else None
        if not isinstance(call, ast.Call):
            return False
        name = self.source.dotted(call.func) or getattr(call.func, "id", "")
        function = self.source.definition(call.func)
        last = function.body[-1:] if isinstance(function, ast.FunctionDef) else []
        ends = (one for one in last if one is not statement)
        return name in _EXITS or any(isinstance(e, ast.Raise) or self._exits(e) for e in ends)

    def _read(self, statement: ast.stmt) -> Iterator[ast.Name]:
        """Yield the names that a statement reads whenever Python comes to it."""
        part: ast.AST = statement
        if isinstance(statement, (ast.If, ast.While)):
            part = statement.test
        elif hasattr(statement, "body"):
            return
        for node in _names(part, ast.Load):
            at_times = any(isinstance(one, _AT_TIMES) for one in self.source.above(node))
            if not at_times and not self.source.is_guarded(node, "NameError", "UnboundLocalError"):
                yield node


def _names(within: ast.AST, context: type[ast.expr_context]) -> Iterator[ast.Name]:
    for node in ast.walk(within):
        if isinstance(node, ast.Name) and isinstance(node.ctx, context):
            yield node


def _is_order(test: ast.expr) -> bool:
    return isinstance(test, ast.Compare) and isinstance(test.ops[0], _ORDERS)


def _skip_equal(one: ast.If, other: ast.If) -> bool:
    """Return whether two conditions compare the same values, and both leave out that they are
    equal, as a > b and a < b do."""
    sides = []
    for test in (one.test, other.test):
        if not isinstance(test, ast.Compare) or not isinstance(test.ops[0], (ast.Lt, ast.Gt)):
            return False
        sides.append({ast.dump(test.left), *map(ast.dump, test.comparators)})
    return sides[0] == sides[1]


def _is_of_end(handler: ast.ExceptHandler) -> bool:
    named = ast.walk(handler.type) if handler.type else ()
    return bool(_OF_END & {getattr(n, "attr", getattr(n, "id", "")) for n in named})


RULE = Rule("static", ("facts",), of_sources(Unbound), also=("python-names",))
