# SPDX-License-Identifier: BSD-3-Clause
"""One Python file, read by `ast`: what names mean and which values are plain. Nothing is run."""

from __future__ import annotations

import ast
import importlib
import warnings

from mrp_check.sources import uses

UNKNOWN = object()  # a value that the source does not say plainly
GAP = "{}"  # what stands in a text for a part that the source does not say plainly
_MAX_TEXT = 10_000


class Source:
    """One Python file.

    file: relative to the package
    tree: its syntax tree
    imports: local name -> dotted name of what it stands for ("rospy", "std_msgs.msg.UInt32")
    has_star: whether it has `from ... import *`
    parents: each node's parent in the tree
    absent: module that it imports and this machine has not -> a sentence that says so
    told: (line, severity) -> the first Finding about it

    Raises SyntaxError (or ValueError) as Python itself does.
    """

    def __init__(self, file, text):
        self.file = file
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.tree = ast.parse(text, file)
        self.parents, self.absent, self.told = {}, {}, {}
        for node in ast.walk(self.tree):
            for child in ast.iter_child_nodes(node):
                self.parents[child] = node
        self.imports, self.import_nodes, self.has_star = {}, [], False
        self._stored = {}
        for node in ast.walk(self.tree):
            self._see(node)

    def _see(self, node):
        if isinstance(node, ast.Import):
            self.import_nodes.append(node)
            for alias in node.names:
                name = alias.asname or alias.name.split(".")[0]
                self.imports[name] = alias.name if alias.asname else name
        elif isinstance(node, ast.ImportFrom):
            self.import_nodes.append(node)
            for alias in node.names:
                if alias.name == "*":
                    self._see_star(node.module or "")
                else:
                    module = "." * node.level + (node.module or "")
                    self.imports[alias.asname or alias.name] = f"{module}.{alias.name}"
        elif isinstance(node, (ast.Assign, ast.AnnAssign, ast.NamedExpr)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                if isinstance(target, (ast.Name, ast.Attribute)):
                    self._store(target, node.value)
                else:
                    for one in ast.walk(target):
                        self._store(one, None)
        elif isinstance(node, (ast.AugAssign, ast.For, ast.comprehension)):
            for one in ast.walk(node.target):
                self._store(one, None)
        elif isinstance(node, ast.withitem) and node.optional_vars:
            for one in ast.walk(node.optional_vars):
                self._store(one, None)
        elif isinstance(node, ast.arg):
            self._store(node, None)
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            self._stored.setdefault((self.scope(node), node.name), []).append(node)
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            for name in node.names:
                self._stored.setdefault((self.function(node), name), []).append(node)

    def _see_star(self, module):
        """Take the names of `from MODULE import *`, if MODULE is one of ROS's own."""
        self.has_star = True
        if not uses.is_ros_package(module.split(".")[0]):
            return
        try:
            found = importlib.import_module(module)
        except Exception:  # the rules about imports say what is wrong with it
            return
        for name in getattr(found, "__all__", [n for n in dir(found) if not n.startswith("_")]):
            self.imports.setdefault(name, f"{module}.{name}")

    def _store(self, target, value):
        key = self.key(target)
        if key:
            self._stored.setdefault(key, []).append(value)

    def names(self):
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

    def above(self, node):
        """Yield the node's parents, the nearest first."""
        while node in self.parents:
            node = self.parents[node]
            yield node

    def scope(self, node):
        """Return the function, lambda, class or module in which the node stands."""
        for parent in self.above(node):
            if isinstance(
                parent,
                (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef, ast.Module),
            ):
                return parent
        return self.tree

    def function(self, node):
        """Return the function in which the node stands, or the module."""
        for parent in self.above(node):
            if isinstance(parent, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.Module)):
                return parent
        return self.tree

    def class_(self, node):
        """Return the class of the method in which the node stands, or None."""
        for parent in self.above(node):
            if isinstance(parent, ast.ClassDef):
                return parent
        return None

    def is_guarded(self, node, *errors):
        """Return whether the node stands in the body of a `try` that catches one of the errors."""
        child = node
        for parent in self.above(node):
            if isinstance(parent, ast.Try) and child in parent.body:
                for handler in parent.handlers:
                    names = (
                        []
                        if handler.type is None
                        else [
                            name.id for name in ast.walk(handler.type) if isinstance(name, ast.Name)
                        ]
                    )
                    if handler.type is None or {"Exception", "BaseException", *errors} & {*names}:
                        return True
            child = parent
        return False

    # What names mean.

    def key(self, target):
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

    def _owner(self, node, name):
        """Return the scope in which a name is bound, as seen from the node."""
        function = self.function(node)
        while not isinstance(function, ast.Module):
            if (function, name) in self._bindings:
                return function
            function = self.function(function)
        return self.tree

    @property
    def _bindings(self):
        if not hasattr(self, "_bound"):
            self._bound = set()
            for node in ast.walk(self.tree):
                if isinstance(node, ast.Name) and isinstance(node.ctx, (ast.Store, ast.Del)):
                    self._bound.add((self.function(node), node.id))
                elif isinstance(node, ast.arg):
                    self._bound.add((self.function(node), node.arg))
                elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                    self._bound.add((self.function(node), node.name))
            for node in ast.walk(self.tree):
                if isinstance(node, (ast.Global, ast.Nonlocal)):
                    for name in node.names:
                        self._bound.discard((self.function(node), name))
        return self._bound

    def stored(self, key):
        """Return all values that are given to a variable; None stands for one that is not plain."""
        return self._stored.get(key, [])

    def dotted(self, node, depth=0):
        """Return the full dotted name of an expression such as rospy.Publisher, or None."""
        parts = []
        while isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        if not isinstance(node, ast.Name) or depth > 5:
            return None
        owner = self._owner(node, node.id)
        if node.id in self.imports:
            base = self.imports[node.id]
        else:
            # As in: Publisher = rospy.Publisher
            values = self.stored((owner, node.id))
            if len(values) != 1 or not isinstance(values[0], (ast.Name, ast.Attribute)):
                return None
            base = self.dotted(values[0], depth + 1)
        return ".".join([base, *reversed(parts)]) if base else None

    def definition(self, node):
        """Return the function, class or lambda that an expression stands for, or None.

        Of a bound method (self.callback) it is the method.
        """
        if isinstance(node, ast.Lambda):
            return node
        if isinstance(node, ast.Name):
            found = self.stored((self._owner(node, node.id), node.id))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            class_ = self.class_(node)
            if node.value.id not in ("self", "cls") or class_ is None:
                return None
            found = self.stored((class_, node.attr))
        else:
            return None
        kinds = (ast.FunctionDef, ast.ClassDef, ast.Lambda)
        return found[0] if len(found) == 1 and isinstance(found[0], kinds) else None

    # Which values are plain.

    def value(self, node, depth=0):
        """Return the plain value of an expression: a number, a truth value, None, or a text.

        In a text, GAP stands for each part that is not plain. UNKNOWN if nothing is.
        """
        if node is None or depth > 20:
            return UNKNOWN
        below = depth + 1
        if isinstance(node, ast.Constant):
            return node.value if not isinstance(node.value, bytes) else UNKNOWN
        if isinstance(node, (ast.Name, ast.Attribute)):
            stored = self.stored(self.key(node)) if self.key(node) else []
            if len(stored) == 1 and isinstance(stored[0], ast.expr):
                return self.value(stored[0], below)
            return UNKNOWN
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

    def _part(self, part, depth):
        if isinstance(part, ast.Constant):
            return str(part.value)
        if part.format_spec is None and part.conversion == -1:
            value = self.value(part.value, depth)
            if isinstance(value, (str, int)):
                return str(value)
        return GAP

    def _binary(self, node, depth):
        left, right = self.value(node.left, depth), self.value(node.right, depth)
        if isinstance(node.op, ast.Mod) and isinstance(left, str):
            return percent(left, self._items(node.right, depth))
        if isinstance(node.op, ast.Add) and (isinstance(left, str) or isinstance(right, str)):
            text = "".join(part if isinstance(part, str) else GAP for part in (left, right))
            return text if len(text) < _MAX_TEXT else UNKNOWN
        numbers = all(
            isinstance(side, (int, float)) and abs(side) < 2**70 for side in (left, right)
        )
        if not numbers:
            return UNKNOWN
        try:
            if isinstance(node.op, ast.Add):
                return left + right
            if isinstance(node.op, ast.Sub):
                return left - right
            if isinstance(node.op, ast.Mult):
                return left * right
            if isinstance(node.op, ast.Div):
                return left / right
            if isinstance(node.op, ast.Pow) and 0 <= right <= 70 and abs(left) <= 16:
                return left**right
            if isinstance(node.op, ast.LShift) and 0 <= right <= 70:
                return left << right
        except (ArithmeticError, TypeError):
            pass
        return UNKNOWN

    def _items(self, node, depth):
        nodes = node.elts if isinstance(node, ast.Tuple) else [node]
        return [self.value(one, depth) for one in nodes]

    def _call(self, node, depth):
        name = self.dotted(node.func)
        if name in ("rospy.resolve_name", "rospy.names.resolve_name") and node.args:
            return self.value(node.args[0], depth)
        if name in ("rospy.Duration", "rospy.Duration.from_sec", "rospy.rostime.Duration"):
            parts = [self.value(argument, depth) for argument in node.args]
            if not node.keywords and parts and all(isinstance(p, (int, float)) for p in parts):
                return parts[0] + (parts[1] / 1e9 if len(parts) > 1 else 0)
            return UNKNOWN
        if isinstance(node.func, ast.Attribute) and node.func.attr == "format":
            text = self.value(node.func.value, depth)
            if isinstance(text, str) and not node.keywords:
                return braces(text, [self.value(argument, depth) for argument in node.args])
        if isinstance(node.func, ast.Name) and node.func.id == "str" and len(node.args) == 1:
            value = self.value(node.args[0], depth)
            return str(value) if isinstance(value, (str, int)) else UNKNOWN
        if isinstance(node.func, ast.Attribute) and node.func.attr == "join" and node.args:
            between = self.value(node.func.value, depth)
            if isinstance(between, str) and isinstance(node.args[0], (ast.List, ast.Tuple)):
                parts = [self.value(one, depth) for one in node.args[0].elts]
                return between.join(p if isinstance(p, str) else GAP for p in parts)
        return UNKNOWN


def percent(text, values):
    """Return a text with its %d, %s and so on filled in: GAP for what is not plain."""
    result, index, position = [], 0, 0
    while True:
        start = text.find("%", position)
        if start < 0:
            return "".join([*result, text[position:]])
        result.append(text[position:start])
        end = start + 1
        while end < len(text) and text[end] in "-+ #0123456789.*lh":
            end += 1
        letter = text[end : end + 1]
        position = end + 1
        if letter == "%":
            result.append("%")
        elif letter == "(":
            close = text.find(")", end)
            position = (close if close > 0 else len(text)) + 2
            result.append(GAP)
        else:
            value = values[index] if index < len(values) else UNKNOWN
            plain = end == start + 1 and isinstance(value, (str, int))
            result.append(str(value) if plain else GAP)
            index += 1


def braces(text, values):
    """Return a text with its {} filled in as str.format does: GAP for what is not plain."""
    result, index, position = [], 0, 0
    while position < len(text):
        letter = text[position]
        if text[position : position + 2] in ("{{", "}}"):
            result.append(letter)
            position += 2
        elif letter == "{":
            close = text.find("}", position)
            if close < 0:
                return UNKNOWN
            inside = text[position + 1 : close]
            number = index if not inside else int(inside) if inside.isdigit() else -1
            value = values[number] if 0 <= number < len(values) else UNKNOWN
            result.append(str(value) if isinstance(value, (str, int)) else GAP)
            index, position = index + 1, close + 1
        else:
            result.append(letter)
            position += 1
    return "".join(result)
