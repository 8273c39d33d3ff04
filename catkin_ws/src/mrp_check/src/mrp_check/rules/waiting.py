# SPDX-License-Identifier: BSD-3-Clause
"""What the nodes of a package wait for, and none of it gives: services and parameters."""

from __future__ import annotations

from typing import Callable, Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import nearest
from mrp_check.sources import asked
from mrp_check.sources.asked import Said

_ALIKE = 0.8


def _findings(case: Case) -> Iterator[Finding]:
    said = {node: [*asked.of(case.package, files)] for node, files in case.facts.sources.items()}
    every = [one for found in said.values() for one in found]
    params = {name.rsplit("/", 1)[-1] for name in (case.launch.params if case.launch else {})}
    services = {one.base for one in every if one.what == "offers"}
    given = params | {one.base for one in every if one.what == "sets"}
    yield from _lacking(said, "asks", services, every, _service)
    yield from _lacking(said, "reads", given, every, _parameter)


def _lacking(
    said: dict[str, list[Said]],
    what: str,
    given: set[str],
    every: list[Said],
    of: Callable[[str, Said, str | None], Finding],
) -> Iterator[Finding]:
    """Yield a Finding for each name that is asked for, and that nothing of the package gives."""
    taken = {one.base for one in every if one.what in (what, "knows")}
    for node, found in said.items():
        told: set[str] = set()
        for one in found:
            if one.what == what and one.base not in given | told:
                told.add(one.base)
                # What somebody asks for is not misspelt.
                yield of(node, one, nearest(one.base, given - taken, _ALIKE))


def _service(node: str, one: Said, near: str | None) -> Finding:
    if near is None:
        message = f"{node} waits for the service {one.name}: no node of this package offers it."
        return Finding("starts", message, one.file, one.line, NOTE, node=node)
    return Finding(
        "starts",
        f"{node} waits for the service {one.name}: the package offers {near}, which nobody asks"
        " for.",
        one.file,
        one.line,
        WARNING,
        expected=near,
        seen=one.name,
        fix="Give both one name.",
        node=node,
    )


def _parameter(node: str, one: Said, near: str | None) -> Finding:
    if near is None:
        message = (
            f"{node} waits for the parameter {one.name}: no launch file and no node of this package"
            " sets it."
        )
        return Finding("starts", message, one.file, one.line, NOTE, node=node)
    return Finding(
        "starts",
        f"{node} waits for the parameter {one.name}: the package sets {near}, which nobody reads.",
        one.file,
        one.line,
        WARNING,
        expected=near,
        seen=one.name,
        fix="Give both one name.",
        node=node,
    )


RULE = Rule("run", 9, ("nodes",), _findings, also=("starts",), only=ANY)
