# SPDX-License-Identifier: BSD-3-Clause
"""Nothing is left when the nodes have ended."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import Package
from mrp_check.run.places import Places


def findings(case: Case) -> Iterator[Finding]:
    seen, spec, package, places = case.observed, case.spec, case.package, case.places
    reported: set[object] = set()
    for left in [one for run in (seen.direct, seen.launch) if run for one in run.left]:
        name = left.node
        if name is None or name not in spec.nodes:
            found = re.search(r"__name:=(\w+)", left.command)
            name = found.group(1) if found and found.group(1) in spec.nodes else None
        alone = seen.alone(name)
        if {(name, "left"), left.command} & reported or alone and alone.killed:
            continue
        reported |= {(name, "left"), left.command}
        file, line = _starts_program(name, package, places)
        name = name or next((node for node in spec.nodes if file in places.sources(node)), None)
        yield Finding(
            "leftovers",
            f"{name or 'The package'} leaves a process behind when it ends: {left.command[:120]}",
            file,
            line,
            expected="no process of the package after its end",
            seen=left.command[:200],
            node=name,
        )


def _starts_program(name: str | None, package: Package, places: Places) -> Where:
    files = places.sources(name) if name else package.of_kind("python", "cpp")
    starts = r"\b(Popen|fork|system|popen|Process)\s*\(|subprocess\.\w+\("
    place = package.first_match(files, starts)
    return place or (places.of(name, Kind.INIT) if name else (None, None))


RULE = Rule(
    stage="stop",
    needs=("nodes",),
    findings=findings,
    requirements={
        "leftovers": Requirement(
            "Nothing is left when the nodes have ended", "launching", evidence.up
        )
    },
)
