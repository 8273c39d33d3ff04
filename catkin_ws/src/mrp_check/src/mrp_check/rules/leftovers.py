# SPDX-License-Identifier: BSD-3-Clause
"""Nothing is left when the nodes have ended."""

from __future__ import annotations

import re

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence


def findings(case):
    seen, spec, package, places = case.observed, case.spec, case.package, case.places
    told = set()
    for left in (seen.direct or {}).get("left", []) + (seen.launch or {}).get("left", []):
        name = left["node"]
        if name is None or name not in spec.nodes:
            found = re.search(r"__name:=(\w+)", left["command"])
            name = found.group(1) if found and found.group(1) in spec.nodes else None
        stuck = (seen.alone(name) or {}).get("ended_by")
        if {(name, "left"), left["command"]} & told or stuck:
            continue
        told |= {(name, "left"), left["command"]}
        file, line = _starts_program(name, package, places)
        name = name or next((node for node in spec.nodes if file in places.sources(node)), None)
        yield Finding(
            "leftovers",
            f"{name or 'The package'} leaves a process behind when it ends:"
            f" {left['command'][:120]}",
            file,
            line,
            expected="no process of the package after its end",
            seen=left["command"][:200],
            node=name,
        )


def _starts_program(name, package, places):
    files = places.sources(name) if name else package.of_kind("python", "cpp")
    starts = r"\b(Popen|fork|system|popen|Process)\s*\(|subprocess\.\w+\("
    place = package.first_match(files, starts)
    return place or (places.of(name, "init") if name else (None, None))


RULE = Rule(
    stage="stop",
    order=20,
    needs=("nodes",),
    findings=findings,
    requirements={
        "leftovers": Requirement(
            "Nothing is left when the nodes have ended", "launching", evidence.up
        )
    },
)
