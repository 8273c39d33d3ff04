# SPDX-License-Identifier: BSD-3-Clause
"""Python: a text with a place for a value is filled: by f before it, by format() or by %."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_rule import PythonRule, of_sources

_PERCENT = re.compile(r"%[-+0 #]*\d*(?:\.\d+)?[sdif]")
_NAME = re.compile(r"\{([A-Za-z_]\w*)[\w.\[\]]*(?:![rsa])?(?::[^{}]*)?\}")


class Unfilled(PythonRule):
    def findings(self) -> Iterator[Finding]:
        yield from self._behind_print()
        for call in self.source.nodes(ast.Call):
            texts = [one for one in call.args if isinstance(one, ast.Constant)]
            for text in texts if self._shows(call) else ():
                found = _NAME.search(text.value) if isinstance(text.value, str) else None
                if self._is_printed_beside(call, text):
                    yield self.finding(
                        "python-names",
                        "print() shows the % as it stands here, and the values behind it: only a %"
                        " between the text and them fills it.",
                        text,
                        severity=WARNING,
                        expected="print(TEXT % (VALUES))",
                        fix="Write % for the comma, and brackets around the values.",
                    )
                elif found and self._is_variable(text, found[1]):
                    yield self.finding(
                        "python-names",
                        f"The text shows {found[0]} as it stands here: Python puts a value there"
                        " only in a text with f before it.",
                        text,
                        severity=WARNING,
                        expected='f"..." or "...".format(...)',
                        fix="Write f before the text.",
                    )

    def _behind_print(self) -> Iterator[Finding]:
        for sum_ in self.source.nodes(ast.BinOp):
            shown = sum_.left
            if isinstance(shown, ast.Call) and getattr(shown.func, "id", "") == "print":
                yield self.finding(
                    "python-names",
                    "print() gives None, and what is done with that here ends with a TypeError:"
                    " a bracket stands too early.",
                    sum_,
                    severity=WARNING,
                    expected="print(TEXT % (VALUES))",
                    fix="Put the values before the last bracket.",
                )

    def _shows(self, call: ast.Call) -> bool:
        """Return whether a call logs, prints or publishes what it is given."""
        name = self.source.dotted(call.func) or ""
        plain = getattr(call.func, "attr", getattr(call.func, "id", ""))
        return name.startswith("rospy.log") or plain in ("print", "publish")

    def _is_printed_beside(self, call: ast.Call, text: ast.Constant) -> bool:
        """Return whether print() is given a format, and as many values behind it."""
        is_first = getattr(call.func, "id", "") == "print" and call.args[0] is text
        places = _PERCENT.findall(text.value) if isinstance(text.value, str) else []
        return is_first and bool(places) and len(call.args) == len(places) + 1

    def _is_variable(self, text: ast.Constant, name: str) -> bool:
        return any(self.source.stored((scope, name)) for scope in self.source.above(text))


RULE = Rule("static", 34, ("facts",), of_sources(Unfilled), also=("python-names",))
