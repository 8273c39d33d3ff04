# SPDX-License-Identifier: BSD-3-Clause
"""A call of a service raises a ServiceException if it fails: who expects an error catches that.

https://docs.ros.org/en/noetic/api/rospy/html/rospy-module.html#ServiceProxy
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, of_sources

# Its own name, and those of the errors that it is one of.
_CATCHES = {"ServiceException", "ROSException", "Exception", "BaseException"}


class Uncaught(PythonRule):
    def findings(self) -> Iterator[Finding]:
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
