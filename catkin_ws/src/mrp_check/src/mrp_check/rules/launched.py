# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong when the nodes of a package run together, under each of its launch files."""

from __future__ import annotations

from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import ERROR, NOTE, WARNING, Finding, Where
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.running.observing import Launched
from mrp_check.running.starting import id_of_error
from mrp_check.running.traces import ends
from mrp_check.running.words import code_text
from mrp_check.sources import asked

_GIVES_UP = "RLException: "
_MILD = (NOTE, WARNING, ERROR)


def _findings(case: Case) -> Iterator[Finding]:
    for launched in case.observed.launches:
        lines = launched.seen.until_asked()
        yield from _gave_up(case, launched, lines)
        raised = [*_raised(case, launched, launched.seen.until_asked(0))]
        # Nobody but this program runs two ways of writing one node at once.
        is_odd = not launched.file and _has_alternatives(case)
        for one in raised if is_odd else ():
            one.severity = min(one.severity, WARNING, key=_MILD.index)
        yield from raised
        waiting = {one.node for one in raised if one.severity == NOTE}
        for path, code in ends(lines).items():
            name = launched.nodes.get(path)
            # What ends by itself, too, has been said.
            if code and name and name not in waiting and not case.nodes[name].not_up:
                finding = _died(case, launched, name, code)
                finding.severity = NOTE if is_odd else finding.severity
                yield finding


def _has_alternatives(case: Case) -> bool:
    """Return whether two nodes call themselves the same, or serve the same action or service."""
    found: list[tuple[str, str]] = []
    for node, files in case.facts.sources.items():
        said = {(one.what, one.base) for one in asked.of(case.package, files)}
        said |= {("is", place.text or node) for place in case.facts.of(node, Kind.INIT)[:1]}
        found += [one for one in said if one[0] in ("is", "offers", "serves")]
    return len(found) > len({*found})


def _where(launched: Launched) -> str:
    return f"under {launched.file}" if launched.file else "together with the other nodes"


def _raised(case: Case, launched: Launched, lines: list[str]) -> Iterator[Finding]:
    found = case.places.traceback(lines)
    if found is None or found[1] == "KeyboardInterrupt":
        return  # that is Ctrl-C
    place, kind, text = found
    nodes = [n for n in launched.nodes.values() if place[0] in case.places.sources(n)]
    name = nodes[0] if nodes else None
    if name is None or case.nodes[name].not_up:
        return
    source = case.package.line(place[0], place[1])
    if "sys.argv[" in source:
        said = f"{name} waits for arguments on its command line: {kind}: {text}"
        yield Finding("starts", said, *place, severity=NOTE, node=name)
        return
    yield Finding(
        id_of_error(kind, text, "callbacks"),
        f"{name} runs into an error {_where(launched)}: {kind}: {text}",
        *place,
        expected="a node that works without an error",
        seen=f"{kind}: {text}, in: {source}",
        node=name,
    )


def _died(case: Case, launched: Launched, name: str, code: int) -> Finding:
    return Finding(
        "starts",
        f"{name} ends {_where(launched)}, {code_text(code)}; by itself it goes on.",
        *case.places.of(name, Kind.INIT, Kind.HANDLE),
        expected="a node that goes on until Ctrl-C",
        seen=code_text(code),
        node=name,
    )


def _gave_up(case: Case, launched: Launched, lines: list[str]) -> Iterator[Finding]:
    """Yield a note if roslaunch ends by itself: it most often wants what is not on this machine."""
    said = next((text for text in lines if text.startswith(_GIVES_UP)), None)
    if launched.seen.ending != "itself" or said is None:
        return
    place: Where = (launched.file, 1) if launched.file else (None, None)
    what = launched.file or "all nodes together"
    yield Finding(
        "starts",
        f"roslaunch gives up on {what}: {said[len(_GIVES_UP) :][:300]}",
        *place,
        severity=NOTE,
        expected="a launch file that goes on until Ctrl-C",
        seen=said[:300],
    )


RULE = Rule(
    "run",
    13,
    ("nodes",),
    _findings,
    also=("starts", "callbacks", "python-names", "python-syntax", "type", "node-start"),
    only=ANY,
)
