# SPDX-License-Identifier: BSD-3-Clause
"""Python: a text that has a variable's name in braces begins with f, or is filled by format()."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_rule import PythonRule, of_sources

_NAME = re.compile(r"\{([A-Za-z_]\w*)[\w.\[\]]*(?:![rsa])?(?::[^{}]*)?\}")


class Unfilled(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for call in self.source.nodes(ast.Call):
            texts = [one for one in call.args if isinstance(one, ast.Constant)]
            for text in texts if self._shows(call) else ():
                found = _NAME.search(text.value) if isinstance(text.value, str) else None
                if found and self._is_variable(text, found[1]):
                    yield self.finding(
                        "python-names",
                        f"The text shows {found[0]} as it stands here: Python puts a value there"
                        " only in a text with f before it.",
                        text,
                        severity=WARNING,
                        expected='f"..." or "...".format(...)',
                        fix="Write f before the text.",
                    )

    def _shows(self, call: ast.Call) -> bool:
        """Return whether a call logs, prints or publishes what it is given."""
        name = self.source.dotted(call.func) or ""
        plain = getattr(call.func, "attr", getattr(call.func, "id", ""))
        return name.startswith("rospy.log") or plain in ("print", "publish")

    def _is_variable(self, text: ast.Constant, name: str) -> bool:
        return any(self.source.stored((scope, name)) for scope in self.source.above(text))


RULE = Rule("static", 34, ("facts",), of_sources(Unfilled), also=("python-names",))
