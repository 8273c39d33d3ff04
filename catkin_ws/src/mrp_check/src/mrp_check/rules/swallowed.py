# SPDX-License-Identifier: BSD-3-Clause
"""Python: what is caught is named, or said: an error that nobody sees is never found."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, of_sources

_ALL = {"Exception", "BaseException"}
_SAYS = {"exc_info", "format_exc", "print_exc", "exception"}


class Swallowed(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for handler in self.source.nodes(ast.ExceptHandler):
            is_all = handler.type is None or getattr(handler.type, "id", "") in _ALL
            if is_all and not self._is_seen(handler) and not self._imports(handler):
                yield self.finding(
                    "python-names",
                    "This catches every error, a misspelt name among them, and does not say which"
                    " one it was.",
                    handler.lineno,
                    severity=WARNING,
                    expected="except and the error that is expected, such as"
                    " rospy.ROSInterruptException",
                    fix="Name the error; or let rospy.logerr() say what it was.",
                )

    def _imports(self, handler: ast.ExceptHandler) -> bool:
        """Return whether only the first of several modules was looked for."""
        tried = self.source.parents[handler]
        return isinstance(tried, ast.Try) and isinstance(
            tried.body[0], (ast.Import, ast.ImportFrom)
        )

    def _is_seen(self, handler: ast.ExceptHandler) -> bool:
        """Return whether what is caught goes on, or is used."""
        within = [node for one in handler.body for node in ast.walk(one)]
        named = {getattr(node, "id", getattr(node, "attr", "")) for node in within}
        goes_on = any(isinstance(node, ast.Raise) for node in within)
        return goes_on or bool(named & {handler.name, *_SAYS})


RULE = Rule("static", 38, ("facts",), of_sources(Swallowed), also=("python-names",), only=ANY)
