# SPDX-License-Identifier: BSD-3-Clause
"""What a C++ node logs is no format: a % in a text that has come from elsewhere is read as one.

https://wiki.ros.org/rosconsole says that the macros take what printf() takes.
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

_LOGS = re.compile(
    r"\b(ROS_(?:DEBUG|INFO|WARN|ERROR|FATAL)(?:_ONCE)?)\s*\(\s*"
    r"((?:[\w.]|->|::|\(\))+(?:\.|->)c_str\(\))\s*\)"
)


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        for file, text in uses.cpp_code(case.package, files).items():
            for match in _LOGS.finditer(text):
                macro, logged = match.groups()
                line = line_of(match)
                yield Finding(
                    "compile",
                    f"{macro}() takes this text for a format: a % in it prints anything, or ends"
                    " the node.",
                    file,
                    line,
                    WARNING,
                    expected=f'{macro}("%s", {logged})',
                    seen=case.package.line(file, line),
                    fix=f'Write {macro}("%s", {logged}).',
                    change=(f"({logged})", f'("%s", {logged})'),
                    node=node,
                )


RULE = Rule("static", 94, ("facts",), _findings, also=("compile",), only=ANY)
