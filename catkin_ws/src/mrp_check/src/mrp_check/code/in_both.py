# SPDX-License-Identifier: BSD-3-Clause
"""The sources of a package's nodes, for rules that say the same of Python and of C++."""

from __future__ import annotations

from typing import Iterator, NamedTuple

from mrp_check.code import uses
from mrp_check.code.python_rule import HasFacts
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.package.package import Package


class OfNode(NamedTuple):
    """A source of a node.

    python: what it says, if it is in Python; code: its text without comments, if it is in C++
    """

    package: Package
    node: str
    file: str
    python: Source | None
    code: str

    def finding(
        self, id_: str, message: str, line: int, expected: str, fix: str, certainty: str = HABIT
    ) -> Finding:
        """Return the Finding about a line of it."""
        seen = self.package.line(self.file, line)
        place = self.file, line, certainty
        return Finding(id_, message, *place, expected, seen, fix, node=self.node)


def each(case: HasFacts) -> Iterator[OfNode]:
    """Yield each source in Python that could be read, and each in C++; headers are left out."""
    for node, files in case.facts.sources.items():
        for file in files:
            source = case.facts.python.get(file)
            if source:
                yield OfNode(case.package, node, file, source, "")
            elif case.package.kind(file) == "cpp":
                yield OfNode(case.package, node, file, None, uses.code(case.package, file))
