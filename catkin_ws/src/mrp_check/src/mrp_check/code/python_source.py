# SPDX-License-Identifier: BSD-3-Clause
"""One Python file, read by `ast`: what names mean and which values are plain. Nothing is run."""

from __future__ import annotations

import ast
import functools
import importlib
import operator
import warnings
from typing import Any, Callable, Iterable, Iterator, Optional, Tuple, TypeVar, Union

from mrp_check.code import uses
from mrp_check.contract.finding import Finding

UNKNOWN = object()  # a value that the source does not say plainly
GAP = "{}"  # what stands in a text for a part that the source does not say plainly
_MAX_TEXT = 10_000  # characters
_NANOSECONDS = 1e9  # of a second
_LARGEST = 2**70  # of a number that is counted with
_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], object]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
# Python's modules of which beginners take all names.
_PLAIN = {"math", "numpy", "random", "socket", "struct", "threading", "time", "tkinter", "turtle"}
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)

T = TypeVar("T", bound=ast.AST)
Function = Union[ast.FunctionDef, ast.Lambda]
Defined = Union[Function, ast.ClassDef]
Stored = Optional[ast.AST]  # what is given to a variable; None if that is not plain
# What tells one variable from others: its scope, and its name in that.
Variable = Tuple[Optional[ast.AST], str]


class Source:
    """One Python file.

    file: relative to the package
    tree: its syntax tree
    imports: local name -> dotted name of what it stands for ("rospy", "std_msgs.msg.UInt32")
    stars: modules of which it takes all names with `from ... import *`, and nobody knows which
    parents: each node's parent in the tree
    absent: module that it imports and this machine has not -> a sentence that says so
    told: line -> the first Finding about it

    Raises SyntaxError (or ValueError) as Python itself does.
    """

    def __init__(self, file: str, text: str | bytes) -> None:
        self.file = file
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.tree = ast.parse(text, file)
        self.parents: dict[ast.AST, ast.AST] = {}
        self.absent: dict[str, str] = {}
        self.told: dict[int, Finding] = {}
        for node in ast.walk(self.tree):
            for child in ast.iter_child_nodes(node):
                self.parents[child] = node
        self.imports: dict[str, str] = {}
        self.import_nodes: list[ast.Import | ast.ImportFrom] = []
        self.stars: list[str] = []
        self._stored: dict[Variable, list[Stored]] = {}
        for node in ast.walk(self.tree):
            self._see(node)

    def _see(self, node: ast.AST) -> None:
        if isinstance(node, ast.Import):
            self.import_nodes.append(node)
            for alias in node.names:
                name = alias.asname or alias.name.split(".")[0]
                self.imports[name] = alias.name if alias.asname else name
        elif isinstance(node, ast.ImportFrom):
            self.import_nodes.append(node)
            module = "." * node.level + (node.module or "")
            for alias in node.names:
                if alias.name == "*":
                    self._see_star(module)
                else:
                    self.imports[alias.asname or alias.name] = f"{module}.{alias.name}"
        elif isinstance(node, (ast.Assign, ast.AnnAssign, ast.NamedExpr)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                if isinstance(target, (ast.Name, ast.Attribute)):
                    self._store(target, node.value)
                else:
                    for part in ast.walk(target):
                        self._store(part, None)
        elif isinstance(node, (ast.AugAssign, ast.For, ast.comprehension)):
            for part in ast.walk(node.target):
                self._store(part, None)
        elif isinstance(node, ast.withitem) and node.optional_vars:
            for part in ast.walk(node.optional_vars):
                self._store(part, None)
        elif isinstance(node, ast.arg):
            self._store(node, None)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            self._stored.setdefault((self.scope(node), node.name), []).append(node)
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            for name in node.names:
                self._stored.setdefault((self.function(node), name), []).append(node)

    def _see_star(self, module: str) -> None:
        """Take the names of `from MODULE import *`, if MODULE is ROS's own, or Python's."""
        try:
            if module not in _PLAIN and not uses.is_installed(module.split(".")[0]):
                raise ImportError
            found = importlib.import_module(module)
        except Exception:  # the rules about imports say what is wrong with it
            self.stars.append(module)
            return
        for name in getattr(found, "__all__", [n for n in dir(found) if not n.startswith("_")]):
            self.imports.setdefault(name, f"{module}.{name}")

    def _store(self, target: ast.AST, value: Stored) -> None:
        key = self.key(target)
        if key:
            self._stored.setdefault(key, []).append(value)

    def names(self) -> set[str]:
        """Return all names that the source mentions: of variables, attributes and imports."""
        found = set()
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Name):
                found.add(node.id)
            elif isinstance(node, ast.Attribute):
                found.add(node.attr)
            elif isinstance(node, ast.alias):
                found.add(node.name.split(".")[-1])
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(node.value)
        return found

    # Where something stands.

    def nodes(self, kind: type[T]) -> Iterator[T]:
        """Yield all nodes of a kind, those on top first."""
        return (node for node in ast.walk(self.tree) if isinstance(node, kind))

    def above(self, node: ast.AST) -> Iterator[ast.AST]:
        """Yield the node's parents, the nearest first."""
        while node in self.parents:
            node = self.parents[node]
            yield node

    def scope(self, node: ast.AST) -> ast.AST:
        """Return the function, lambda, class or module in which the node stands."""
        kinds = (*_FUNCTIONS, ast.ClassDef)
        return next((outer for outer in self.above(node) if isinstance(outer, kinds)), self.tree)

    def function(self, node: ast.AST) -> ast.AST:
        """Return the function in which the node stands, or the module."""
        return next(
            (outer for outer in self.above(node) if isinstance(outer, _FUNCTIONS)), self.tree
        )

    def class_(self, node: ast.AST) -> ast.ClassDef | None:
        """Return the class of the method in which the node stands, or None."""
        return next((outer for outer in self.above(node) if isinstance(outer, ast.ClassDef)), None)

    def is_guarded(self, node: ast.AST, *errors: str) -> bool:
        """Return whether the node stands in the body of a `try` that catches one of the errors."""
        caught, child = {"Exception", "BaseException", *errors}, node
        for parent in self.above(node):
            if isinstance(parent, ast.Try) and child in parent.body:
                for handler in parent.handlers:
                    named = ast.walk(handler.type) if handler.type else ()
                    if handler.type is None or caught & {getattr(part, "id", "") for part in named}:
                        return True
            child = parent
        return False

    # What names mean.

    def key(self, target: ast.AST) -> Variable | None:
        """Return what tells one variable from others: (its scope, its name)."""
        if isinstance(target, ast.Name):
            return self._owner(target, target.id), target.id
        if isinstance(target, ast.arg):
            return self.function(target), target.arg
        if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name):
            if target.value.id in ("self", "cls"):
                return self.class_(target), target.attr
            return (self._owner(target, target.value.id), f"{target.value.id}.{target.attr}")
        return None

    def _owner(self, node: ast.AST, name: str) -> ast.AST:
        """Return the scope in which a name is bound, as seen from the node."""
        function = self.function(node)
        while not isinstance(function, ast.Module):
            if (function, name) in self.bindings:
                return function
            function = self.function(function)
        return self.tree

    @functools.cached_property
    def bindings(self) -> set[Variable]:
        bound: set[Variable] = set()
        declared: set[Variable] = set()
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Name) and isinstance(node.ctx, (ast.Store, ast.Del)):
                bound.add((self.function(node), node.id))
            elif isinstance(node, ast.arg):
                bound.add((self.function(node), node.arg))
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                bound.add((self.function(node), node.name))
            elif isinstance(node, (ast.Global, ast.Nonlocal)):
                declared |= {(self.function(node), name) for name in node.names}
        return bound - declared

    def stored(self, key: Variable | None) -> list[Stored]:
        """Return all values that are given to a variable; None stands for one that is not plain."""
        return self._stored.get(key, []) if key else []

    def dotted(self, node: ast.AST | None, depth: int = 0) -> str | None:
        """Return the full dotted name of an expression such as rospy.Publisher, or None."""
        parts = []
        while isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        if not isinstance(node, ast.Name) or depth > 5:
            return None
        owner = self._owner(node, node.id)
        base = self.imports.get(node.id)
        if base is None:
            # As in: Publisher = rospy.Publisher
            values = self.stored((owner, node.id))
            if node.id == "sys" and not values:  # from another module, of which it takes all names
                return ".".join(["sys", *reversed(parts)])
            if len(values) != 1 or not isinstance(values[0], (ast.Name, ast.Attribute)):
                return None
            base = self.dotted(values[0], depth + 1)
        return ".".join([base, *reversed(parts)]) if base else None

    def definition(self, node: ast.AST | None) -> Defined | None:
        """Return the function, class or lambda that an expression stands for, or None.

        Of a bound method (self.callback) it is the method.
        """
        if isinstance(node, ast.Lambda):
            return node
        if isinstance(node, ast.Name):
            found = self.stored((self._owner(node, node.id), node.id))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            class_ = self.class_(node)
            if node.value.id not in ("self", "cls"):
                class_ = self.class_of(node.value)
            if class_ is None:
                return None
            found = self.stored((class_, node.attr))
        else:
            return None
        kinds = (ast.FunctionDef, ast.ClassDef, ast.Lambda)
        return found[0] if len(found) == 1 and isinstance(found[0], kinds) else None

    def only(self, node: ast.AST) -> ast.expr | None:
        """Return the one expression that a variable is ever given, or None."""
        stored = self.stored(self.key(node))
        return stored[0] if len(stored) == 1 and isinstance(stored[0], ast.expr) else None

    def made(self, node: ast.AST) -> ast.Call | None:
        """Return the call whose result is all that a variable is ever given, or None."""
        call = self.only(node)
        return call if isinstance(call, ast.Call) else None

    def class_of(self, node: ast.AST) -> ast.ClassDef | None:
        """Return the class of the source's own of which a variable is an object, or None."""
        made = self.made(node)
        class_ = self.definition(made.func) if made else None
        return class_ if isinstance(class_, ast.ClassDef) else None

    def called(self, parts: Iterable[ast.AST]) -> list[ast.FunctionDef]:
        """Return the source's own functions that some parts of it call, and what those call."""
        found: list[ast.FunctionDef] = []
        nodes = [node for part in parts for node in ast.walk(part)]
        for node in nodes:  # it grows
            function = self.definition(node.func) if isinstance(node, ast.Call) else None
            if isinstance(function, ast.FunctionDef) and function not in found:
                found.append(function)
                nodes += ast.walk(function)
        return found

    # Which values are plain.

    def value(self, node: ast.AST | None, depth: int = 0) -> object:
        """Return the plain value of an expression: a number, a truth value, None, or a text.

        In a text, GAP stands for each part that is not plain. UNKNOWN if nothing is.
        """
        if node is None or depth > 20:
            return UNKNOWN
        below = depth + 1
        if isinstance(node, ast.Constant):
            return node.value if not isinstance(node.value, bytes) else UNKNOWN
        if isinstance(node, (ast.Name, ast.Attribute)):
            only = self.only(node)
            return self.value(only, below) if only else UNKNOWN
        if isinstance(node, ast.JoinedStr):
            parts = [self._part(part, below) for part in node.values]
            return "".join(parts)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            number = self.value(node.operand, below)
            return -number if isinstance(number, (int, float)) else UNKNOWN
        if isinstance(node, ast.BinOp):
            return self._binary(node, below)
        if isinstance(node, ast.Call):
            return self._call(node, below)
        return UNKNOWN

    def _part(self, part: ast.expr, depth: int) -> str:
        if isinstance(part, ast.Constant):
            return str(part.value)
        if not isinstance(part, ast.FormattedValue):
            return GAP
        if part.format_spec is None and part.conversion == -1:
            value = self.value(part.value, depth)
            if isinstance(value, (str, int)):
                return str(value)
        return GAP

    def _binary(self, node: ast.BinOp, depth: int) -> object:
        left, right = self.value(node.left, depth), self.value(node.right, depth)
        if isinstance(node.op, ast.Add) and (isinstance(left, str) or isinstance(right, str)):
            text = "".join(part if isinstance(part, str) else GAP for part in (left, right))
            return text if len(text) < _MAX_TEXT else UNKNOWN
        if not isinstance(left, (int, float)) or not isinstance(right, (int, float)):
            return UNKNOWN
        compute = _OPERATORS.get(type(node.op))
        if compute is None or max(abs(left), abs(right)) >= _LARGEST:
            return UNKNOWN
        try:
            return compute(left, right)
        except (ArithmeticError, TypeError):
            return UNKNOWN

    def _call(self, node: ast.Call, depth: int) -> object:
        name = self.dotted(node.func)
        if name in ("rospy.resolve_name", "rospy.names.resolve_name") and node.args:
            return self.value(node.args[0], depth)
        if name in ("rospy.Duration", "rospy.Duration.from_sec", "rospy.rostime.Duration"):
            parts = [self.value(argument, depth) for argument in node.args]
            numbers = [part for part in parts if isinstance(part, (int, float))]
            if node.keywords or not parts or len(numbers) < len(parts):
                return UNKNOWN
            return numbers[0] + (numbers[1] / _NANOSECONDS if len(numbers) > 1 else 0)
        return UNKNOWN
