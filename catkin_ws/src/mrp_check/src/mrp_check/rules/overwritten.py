# SPDX-License-Identifier: BSD-3-Clause
"""A node does not set a parameter before it reads it: what a launch file has set is lost then."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources import asked

_ASKS = re.compile(r"\b(has_?[pP]aram|search_?[pP]aram)\b")
_PLAIN = re.compile(
    r"""\bset_?[pP]aram\s*\(\s*["'][~/\w]+["']\s*,\s*(?:-?[\d.]+|[A-Z_]+\s*\)|["'][^"']*["'])"""
)


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        if case.package.first_match(files, _ASKS.pattern):
            continue
        said = [*asked.of(case.package, files)]
        for one in said:
            text = case.package.line(one.file, one.line)
            reads = [two for two in said if two.what == "knows" and two.name == one.name]
            later = [two for two in reads if two.file == one.file and two.line > one.line]
            if one.what == "sets" and _PLAIN.search(text) and later and len(later) == len(reads):
                yield Finding(
                    "starts",
                    f"{node} sets the parameter {one.name} each time that it starts, and reads it"
                    f" in line {later[0].line}: what a launch file or somebody has set is lost.",
                    one.file,
                    one.line,
                    WARNING,
                    expected="a default where it is read",
                    seen=text.strip(),
                    fix="Take this line out, and give the value as the default when it is read.",
                    node=node,
                )
                break


RULE = Rule("static", 99, ("facts",), _findings, also=("starts",), only=ANY)
