# SPDX-License-Identifier: BSD-3-Clause
"""Python: what a function declares `global` is a name of the module, spelt as it is there."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import nearest
from mrp_check.sources.python_rule import PythonRule, of_sources


class LostGlobal(PythonRule):
    def findings(self) -> Iterator[Finding]:
        names = [node for node in self.source.nodes(ast.Name)]
        used = {node.id for node in names} | {*self.source.imports}
        tree = self.source.tree
        own = {
            node.id
            for node in names
            if isinstance(node.ctx, ast.Store) and self.source.function(node) is tree
        }
        for node in self.source.nodes(ast.Global):
            for name in node.names:
                near = nearest(name, own, 0.8)
                if name not in used and near:
                    yield self.finding(
                        "python-names",
                        f"`global {name}` names nothing of this file, which has {near}: what the"
                        f" function gives to {near} stays its own.",
                        node,
                        severity=WARNING,
                        expected=f"global {near}",
                        fix=f"Write {near} for {name}.",
                        change=(name, near),
                    )


RULE = Rule("static", 118, ("facts",), of_sources(LostGlobal), also=("python-names",), only=ANY)
