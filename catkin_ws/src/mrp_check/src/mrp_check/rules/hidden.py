# SPDX-License-Identifier: BSD-3-Clause
"""A class or a function of a source has a name of its own, not that of what it imports: after its
definition the name stands for it alone."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, of_sources


class Hidden(PythonRule):
    def findings(self) -> Iterator[Finding]:
        imported = {
            alias.asname or alias.name: one
            for one in self.source.tree.body
            if isinstance(one, ast.ImportFrom)
            for alias in one.names
        }
        for one in self.source.tree.body:
            if isinstance(one, (ast.ClassDef, ast.FunctionDef)) and one.name in imported:
                yield self.finding(
                    "python-names",
                    f"{one.name} is imported in line {imported[one.name].lineno}, and stands for"
                    " what is defined here from now on: nothing can use what was imported.",
                    one,
                    severity=WARNING,
                    expected="a name of its own",
                    fix=f"Give it another name than {one.name}; or take the import out.",
                )


RULE = Rule("static", 126, ("facts",), of_sources(Hidden), also=("python-names",), only=ANY)
