# SPDX-License-Identifier: BSD-3-Clause
"""Python: `from absent.srv import *` gives the names of services alone. A misspelt variable is not
one of them, even if nobody can look into that package."""

from __future__ import annotations

from typing import Iterator

from pyflakes import checker, messages

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import nearest
from mrp_check.sources.python_rule import PythonRule, of_sources

_NEAR = 0.85


class Starred(PythonRule):
    def findings(self) -> Iterator[Finding]:
        stars = {*self.source.stars}
        if not stars or not all(one.endswith((".msg", ".srv")) for one in stars):
            return
        if all(self.is_own(one) for one in stars):
            return  # what they have is known: another rule says what they have not
        given = {name for scope, name in self.source.bindings if scope is self.source.tree}
        found = checker.Checker(self.source.tree, self.file).messages
        for message in found:
            name = str(message.message_args[0]) if message.message_args else ""
            near = nearest(name, given, _NEAR)
            if isinstance(message, messages.ImportStarUsage) and name[:1].islower() and near:
                yield self.finding(
                    "python-names",
                    f"Nothing here is called {name}, and messages have other names. Perhaps {near}"
                    " is meant.",
                    message.lineno,
                    severity=WARNING,
                    expected=near,
                    fix=f"Write one of {name} and {near} in both places.",
                )
                return


RULE = Rule("static", 123, ("facts",), of_sources(Starred), also=("python-names",), only=ANY)
