# SPDX-License-Identifier: BSD-3-Clause
"""What all rules about a Python source have in common."""

from __future__ import annotations

import ast
from typing import Any, Callable, Iterator, Protocol

from mrp_check.code.facts import Facts
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.package.package import Package


class HasFacts(Protocol):
    """A case.Case, as far as of_sources() needs one."""

    @property
    def package(self) -> Package: ...

    @property
    def facts(self) -> Facts: ...


class PythonRule:
    """A rule about one source; `findings` yields what it finds."""

    def __init__(self, package: Package, source: Source) -> None:
        self.package = package
        self.source = source
        self.file = source.file

    def findings(self) -> Iterator[Finding]:
        raise NotImplementedError

    def finding(
        self, id_: str, message: str, node: ast.stmt | ast.expr | int, **more: Any
    ) -> Finding:
        line = node if isinstance(node, int) else node.lineno
        more.setdefault("seen", self.package.line(self.file, line))
        finding = Finding(id_, message, self.file, line, **more)
        # Of several findings about one line, the first is the cause.
        if finding.certainty not in (HABIT, HINT):
            cause = self.source.told.setdefault(line, finding)
            finding.consequence_of = cause.id if cause is not finding else None
        return finding

    def is_own(self, name: str) -> bool:
        """Return whether a module is the package's own (made, or generated of its messages)."""
        top = name.split(".")[0]
        # Python does not find the folder of a script by its name.
        others = [] if top in self.file.split("/") else self.package.of_kind("python")
        is_inside = any(f"/{top}/" in f"/{path}" for path in others)
        return top == self.package.name or is_inside or self.has_module(top)

    def has_module(self, name: str) -> bool:
        """Return whether a file of the package is a module of that name."""
        path = name.replace(".", "/")
        paths = [f"/{file}" for file in self.package.of_kind("python")]
        return any(file.endswith((f"/{path}.py", f"/{path}/__init__.py")) for file in paths)

    def written(self, node: ast.expr) -> str:
        """Return an expression as it is written."""
        return ast.get_source_segment(self.package.text(self.file), node) or ""


def arguments_of(call: ast.Call) -> list[ast.expr]:
    """Return all that a call is given, by its place or by its name."""
    return [*call.args, *(keyword.value for keyword in call.keywords)]


def of_sources(rule: type[PythonRule]) -> Callable[[HasFacts], Iterator[Finding]]:
    """Return the function of a case.Case that asks a PythonRule of each source that matters."""

    def findings(case: HasFacts) -> Iterator[Finding]:
        for file in case.facts.relevant:
            if file in case.facts.python:
                yield from rule(case.package, case.facts.python[file]).findings()

    return findings
