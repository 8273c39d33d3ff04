# SPDX-License-Identifier: BSD-3-Clause
"""Fields that a message has not."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_facts import argument
from mrp_check.code.python_rule import MessageClass, PythonRule, of_sources
from mrp_check.code.python_source import Function, Variable
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import nearest, perhaps


class Messages(PythonRule):
    def findings(self) -> Iterator[Finding]:
        yield from self.unknown_fields()
        yield from self.unknown_arguments()

    def unknown_fields(self) -> Iterator[Finding]:
        for key, class_ in self._messages().items():
            for node in self.source.nodes(ast.Attribute):
                if self.source.key(node.value) == key and not hasattr(class_, node.attr):
                    near = nearest(node.attr, class_.__slots__)
                    hint = perhaps(near)
                    if not near and len(class_.__slots__) == 1:
                        near = class_.__slots__[0]
                        hint = f" Its only field is {near}."
                    yield self.finding(
                        "python-names",
                        f"A message {class_._type} has no field {node.attr}: Python ends with an"
                        f" AttributeError when it comes here.{hint}",
                        node,
                        expected=", ".join(class_.__slots__) or "no field at all",
                        fix=f"Write {near} for {node.attr}." if near else "Correct the name.",
                        why="no-such-field",
                    )

    def _messages(self) -> dict[Variable, MessageClass]:
        """Return variable -> class, for the variables that hold a message of a known class."""
        found = {}
        for node in ast.walk(self.source.tree):
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
                class_ = self.message_class(node.value.func)
                for target in node.targets:
                    key = self.source.key(target)
                    if class_ and key and len(self.source.stored(key)) == 1:
                        found[key] = class_
            elif isinstance(node, ast.Call) and self.source.dotted(node.func) == "rospy.Subscriber":
                class_ = self.message_class(argument(node, 1, "data_class"))
                callback = argument(node, 2, "callback")
                function = self.source.definition(callback) if callback is not None else None
                if class_ is None or not isinstance(function, (ast.FunctionDef, ast.Lambda)):
                    continue
                names = function.args.args
                first = 1 if isinstance(callback, ast.Attribute) else 0
                if len(names) > first and not self._called(function):
                    key = (function, names[first].arg)
                    if len(self.source.stored(key)) == 1:
                        found[key] = class_
        return found

    def _called(self, function: Function) -> bool:
        """Return whether a function is called, or handed over, in more than one place."""
        name = getattr(function, "name", None)
        loaded = (n for n in self.source.nodes(ast.Name) if isinstance(n.ctx, ast.Load))
        names = [n.id for n in loaded] + [n.attr for n in self.source.nodes(ast.Attribute)]
        return name is not None and names.count(name) > 1

    def unknown_arguments(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Call):
            class_ = self.message_class(node.func)
            yield from self._arguments(node, class_) if class_ is not None else ()

    def _arguments(self, node: ast.Call, class_: MessageClass) -> Iterator[Finding]:
        for keyword in node.keywords:
            if keyword.arg and keyword.arg not in class_.__slots__:
                near = nearest(keyword.arg, class_.__slots__)
                yield self.finding(
                    "python-names",
                    f"A message {class_._type} has no field {keyword.arg}: Python ends with an"
                    " AttributeError when it comes here." + perhaps(near),
                    node,
                    expected=", ".join(class_.__slots__),
                    fix=f"Write {near} for {keyword.arg}." if near else "Correct the name.",
                )


RULE = Rule("static", ("facts",), of_sources(Messages), also=("python-names",))
