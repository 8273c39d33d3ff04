# SPDX-License-Identifier: BSD-3-Clause
"""A node does what each example of the contract says, and has the parameters that it needs."""

from __future__ import annotations

from typing import Iterator, Mapping, Sequence

from mrp_check.confined import fitting
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Alone
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.names import nearest
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Example, Message
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.run.node import Node, each_node
from mrp_check.run.planning import resolved
from mrp_check.run.words import fields_text


def _findings(case: Case) -> Iterator[Finding]:
    """Yield a Finding for each parameter that the launch file should set, and does not; and for
    the first example of each node that does not come out as the contract says."""
    for node in case.nodes.values():
        for name, value in node.wanted.parameters.items() if node.started else ():
            given = case.launch.params if case.launch else {}
            seen = given.get(f"{node.path}/{name}")
            if seen == value:
                continue
            own = [full.rsplit("/", 1)[1] for full in given if full.startswith(node.path + "/")]
            near = nearest(name, own) or ""
            shown = f"{name} = {seen}" if seen is not None else near or "no such parameter"
            file, line = node.places.in_launch_file(node.name)
            named = node.package.find_line(file, f'name="{near or name}"') if file else None
            yield node.finding(
                "parameters",
                f"The launch file gives {node.name} {shown}, not {name} = {value}.",
                (file, named or line),
                expected=f'<param name="{name}" value="{value}"/> inside the <node>',
                seen=shown,
            )
    yield from each_node(_of)(case)


def _of(node: Node) -> Iterator[Finding]:
    """Yield a Finding for the first example that does not come out as the contract says."""
    for number, example in enumerate(node.wanted.examples):
        ran = node.ran_for(number)
        if ran and ran.replies is not None:
            found = _of_example(node, example, ran)
            if found:
                yield found
                return


def _of_example(node: Node, example: Example, ran: Alone) -> Finding | None:
    path = f"{(ran.name or '').rsplit('/', 1)[0]}/~"
    for name, wanted in example.publishes.items():
        replies = (ran.replies or {}).get(resolved(node.spec.topics[name], path), [])
        periods = [role.period for role in node.wanted.published if role.topic.name == name]
        rest = example.tolerance, bool(example.receives and any(periods))
        if fitting.follow([{**message} for message in wanted], replies, *rest):
            continue
        fields = list(dict.fromkeys(field for message in wanted for field in message))
        seen: list[Message] = [
            {field: reply.get(field, "nothing") for field in fields} for reply in replies
        ]
        wrong = {
            field: found[field]
            for message, found in zip(wanted, seen)
            for field, value in message.items()
            if not fitting.fits({field: value}, {**found}, example.tolerance)
        }
        place, why = _cause(node, example, ran, wrong)
        return node.finding(
            "examples",
            f"{node.name}{_given(example)} publishes {_shown(seen)} on {name},"
            f" not {_shown(wanted)}.{why}",
            place,
            expected=_shown(wanted),
            seen=_shown(seen),
        )
    return None


def _given(example: Example) -> str:
    parameters = [f"{name} = {value}" for name, value in example.parameters.items()]
    sent = [
        f"{fields_text(message, 'a message')} on {topic.name}"
        for topic, message in example.receives
    ]
    started = f", started with {', '.join(parameters)}," if parameters else ""
    return started + (f" is sent {', '.join(sent)}, and" if sent else "")


def _cause(node: Node, example: Example, ran: Alone, wrong: Message) -> tuple[Where, str]:
    """Return the most likely place of what is wrong, and what more to say.

    wrong: the fields that have another value
    """
    raised = node.places.traceback(text for _, _, text in ran.lines)
    if raised:
        return raised[0], f" {raised[1]}: {raised[2]}"
    reads = node.places.facts.asked(node.places.sources(node.name), Kind.READS)
    for name in example.parameters:
        same = [read for read in reads if read.base == name]
        if not same:
            place = (
                (reads[0].file, reads[0].line) if reads else node.places.of(node.name, Kind.INIT)
            )
            return place, f" Nothing reads the parameter {name}."
        if not (same[0].text or "").startswith("~") and node.package.kind(same[0].file) == "python":
            return (same[0].file, same[0].line), " A private parameter's name begins with ~."
    texts = [node.places.of_text(node.name, v) for v in wrong.values() if isinstance(v, str)]
    line = next(filter(None, texts), None) or node.places.of_setting(node.name, wrong)
    return line or node.places.of(node.name, Kind.DATA, Kind.PUBLISH), ""


def _shown(messages: Sequence[Mapping[str, object]]) -> str:
    shown = "; ".join(fields_text(message, "a message") for message in messages[:4])
    return shown + ("; ..." if len(messages) > 4 else "") or "nothing"


def _replied(node: Node) -> bool:
    runs = [node.ran_for(number) for number in range(len(node.wanted.examples))]
    return all(run and run.replies is not None for run in runs)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=_findings,
    requirements={
        "parameters": Requirement(
            "The launch file sets the parameters", "parameters", evidence.launch
        ),
        "examples": Requirement(
            "Each example of the contract gives the right result",
            "contract",
            evidence.when(_replied, "wasn't seen in its examples", lambda wanted: wanted.examples),
        ),
    },
    only=CONTRACT,
)
