# SPDX-License-Identifier: BSD-3-Clause
"""What the text of a C++ node shows where it could not be built: it asks to be called back, and
never spins."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import uses

_CALLED_BACK = re.compile(r"(?:\.|->)(createTimer|createWallTimer|subscribe|advertiseService)\b")
_SPINS = re.compile(r"[sS]pin|callAvailable|callOne|waitForShutdown")


def _findings(case: Case) -> Iterator[Finding]:
    for name, files in case.facts.sources.items():
        node = case.nodes.get(name)
        texts = {f: uses.code(case.package, f) for f in files if case.package.kind(f) == "cpp"}
        joined = "\n".join(texts.values())
        if not node or node.is_up or "ros::init" not in joined or _SPINS.search(joined):
            continue
        for file, text in texts.items():
            called = _CALLED_BACK.search(text)
            if called:
                line = line_of(called, 1)
                yield Finding(
                    "spin",
                    f"{name} asks to be called back here, and never spins: nothing calls it.",
                    file,
                    line,
                    WARNING,
                    expected="ros::spin() at the end of main",
                    seen=case.package.lines(file)[line - 1].strip(),
                    fix="Write ros::spin() at the end of main.",
                    node=name,
                )


RULE = Rule("run", 24, ("nodes",), _findings, also=("spin",), only=ANY)
