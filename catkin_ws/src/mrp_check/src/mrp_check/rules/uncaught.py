# SPDX-License-Identifier: BSD-3-Clause
"""What raises an error where something is not there yet is caught: what asks for a transform; and a
call of a service, by who expects an error at all.

https://docs.ros.org/en/noetic/api/rospy/html/rospy-module.html#ServiceProxy
https://wiki.ros.org/tf/Tutorials/tf%20and%20Time%20%28Python%29
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, of_sources

# Its own name, and those of the errors that it is one of.
_CATCHES = {"ServiceException", "ROSException", "Exception", "BaseException"}
_TRANSFORMS = {"waitForTransform", "lookupTransform", "lookup_transform", "transformPose"}
# The names of its errors, and of the modules before them.
_CATCH_TRANSFORMS = ("TransformException", "LookupException", "tf", "tf2", "tf2_ros")


class Uncaught(PythonRule):
    def findings(self) -> Iterator[Finding]:
        yield from self._transforms()
        yield from self._services()

    def _transforms(self) -> Iterator[Finding]:
        modules = {one.split(".")[0] for one in self.source.imports.values()}
        for call in self.source.nodes(ast.Call) if modules & {"tf", "tf2_ros"} else ():
            name = getattr(call.func, "attr", "")
            if name in _TRANSFORMS and not self._is_tried(call):
                yield self.finding(
                    "starts",
                    f"{name}() raises an error where there is no transform yet, and nothing catches"
                    " it: the node ends with a traceback.",
                    call,
                    severity=WARNING,
                    expected=f"try: around {name}()",
                    fix="Catch the errors of tf, and try again.",
                )

    def _is_tried(self, call: ast.Call) -> bool:
        """Return whether the errors of tf are caught here, or by who calls the function."""
        function = self.source.function(call)
        callers = (
            c for c in self.source.nodes(ast.Call) if self.source.definition(c.func) is function
        )
        return any(self.source.is_guarded(one, *_CATCH_TRANSFORMS) for one in (call, *callers))

    def _services(self) -> Iterator[Finding]:
        for tried in self.source.nodes(ast.Try):
            calls = [one for part in tried.body for one in ast.walk(part) if self._asks(one)]
            caught = [one.type for one in tried.handlers]
            names = [ast.walk(one) for one in caught if one]
            named = {getattr(n, "attr", getattr(n, "id", "")) for nodes in names for n in nodes}
            is_plain = None not in caught and len(caught) == 1 and "rospy" in named
            if calls and is_plain and not named & _CATCHES:
                if not self.source.is_guarded(tried, *_CATCHES):
                    yield self.finding(
                        "starts",
                        "A call of a service that fails raises a rospy.ServiceException, which is"
                        " not caught here: the program ends with a traceback.",
                        tried.handlers[0].lineno,
                        severity=WARNING,
                        expected="except rospy.ServiceException",
                        fix="Catch rospy.ServiceException, too.",
                    )

    def _asks(self, node: ast.AST) -> bool:
        """Return whether a node calls what rospy.ServiceProxy() returned."""
        made = self.source.made(node.func) if isinstance(node, ast.Call) else None
        return made is not None and self.source.dotted(made.func) == "rospy.ServiceProxy"


RULE = Rule("static", 124, ("facts",), of_sources(Uncaught), also=("starts",), only=ANY)
