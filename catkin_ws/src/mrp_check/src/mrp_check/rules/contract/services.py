# SPDX-License-Identifier: BSD-3-Clause
"""Nodes offer and call the services that the contract says."""

from __future__ import annotations

import ast
from typing import Iterator, Mapping, Sequence

from mrp_check.confined import fitting
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Answer
from mrp_check.contract.finding import Finding, Where
from mrp_check.contract.names import last_part, nearest
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Message, Service
from mrp_check.run import evidence
from mrp_check.run.node import Node, each_node
from mrp_check.run.planning import resolved
from mrp_check.run.traces import ROS_SERVICES
from mrp_check.run.words import few, fields_text


def _of(node: Node) -> Iterator[Finding]:
    alone = node.direct
    for service in node.wanted.offers if alone and node.own_name else ():
        answers = alone.answers.get(_key(node, service)) if alone else None
        if answers is None:
            yield _not_offered(node, service)
        else:
            yield from _answers(node, service, answers)
    for service in node.wanted.calls if alone and node.own_name else ():
        yield from _requests(node, service, alone.requests if alone else {})


def _key(node: Node, service: Service) -> str:
    """Return the service's name in the run of the node by itself."""
    return resolved(service, f"{(node.own_name or '').rsplit('/', 1)[0]}/~")


def _not_offered(node: Node, service: Service) -> Finding:
    offered = {registration.topic for registration in node.seen_alone.services}
    others = sorted(last_part(name) for name in offered if last_part(name) not in ROS_SERVICES)
    return node.finding(
        "services",
        f"{node.name} offers {few(others) or 'no service'}, not {service.name}.",
        node.places.asked(node.name, Kind.OFFERS, nearest(service.name, others) or ""),
        expected=f"the service {service.name}",
        seen=few(others) or "no service",
    )


def _answers(node: Node, service: Service, answers: list[Answer]) -> Iterator[Finding]:
    """Yield the Finding about the first call that is not answered as the contract says."""
    place = node.places.asked(node.name, Kind.OFFERS, service.name)
    for number, call in enumerate(service.examples):
        asked = f"{node.name}, asked {fields_text(call.request)} on {service.name},"
        answer = answers[number] if number < len(answers) else Answer(None, "it never answered")
        if answer.fields is None:
            is_type = "md5sum" in answer.error or "Incompatible" in answer.error
            kind = service.type_in(node.package.name)
            lines = [text for _, _, text in node.direct.lines] if node.direct else []
            found = node.places.traceback(lines)
            yield node.finding(
                "services",
                f"{asked} gives no answer: {answer.error}.",
                found[0] if found and not is_type else place,
                expected=kind if is_type else fields_text(call.response),
                seen=f"{found[1]}: {found[2]}" if found and not is_type else answer.error,
            )
        elif not fitting.fits({**call.response}, answer.fields, call.tolerance):
            seen = {path: answer.fields.get(path, "nothing") for path in call.response}
            yield node.finding(
                "services",
                f"{asked} answers {fields_text(seen)}, not {fields_text(call.response)}.",
                _answering(node, call.response) or place,
                expected=fields_text(call.response),
                seen=fields_text(seen),
            )
        else:
            continue
        return


def _answering(node: Node, response: Message) -> Where | None:
    """Return the place at which a response gets its fields, or None."""
    place = node.places.of_setting(node.name, response)
    sources = map(node.places.facts.python.get, node.places.sources(node.name))
    for source in [] if place else filter(None, sources):
        for call in source.nodes(ast.Call):
            is_response = (source.dotted(call.func) or "").endswith("Response")
            is_returned = isinstance(source.parents.get(call), ast.Return)
            if is_response and (is_returned or call.args or call.keywords):
                return source.file, call.lineno
    return place


def _requests(
    node: Node, service: Service, requests: Mapping[str, Sequence[Message]]
) -> Iterator[Finding]:
    asked = requests.get(_key(node, service), [])
    place = node.places.asked(node.name, Kind.ASKS, service.name)
    expected = " or ".join(fields_text(call.request) for call in service.examples[:4])
    if not asked:
        others = {last_part(registration.topic) for registration in node.seen_alone.lookups} - {
            service.name
        }
        looked = f": it looks for {few(sorted(others))}" if others else ""
        yield node.finding(
            "services",
            f"{node.name} never calls {service.name}{looked}.",
            node.places.asked(node.name, Kind.ASKS, next(iter(sorted(others)), service.name)),
            expected=f"a call of {service.name}" + (f" with {expected}" if expected else ""),
            seen=few(sorted(others)) or "no call",
        )
    for sent in asked if service.examples else ():
        known = [c for c in service.examples if fitting.fits({**c.request}, {**sent}, c.tolerance)]
        if not known:
            seen = fields_text(
                {path: sent.get(path, "nothing") for path in service.examples[0].request}
            )
            yield node.finding(
                "services",
                f"{node.name} asks {service.name} for {seen}, which no example of the contract"
                " does.",
                place,
                expected=expected,
                seen=seen,
            )
            return


_asked = evidence.when(
    lambda node: node.own_name, "didn't run", lambda wanted: wanted.offers or wanted.calls
)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=each_node(_of),
    requirements={
        "services": Requirement("Services behave as the contract says", "contract", _asked)
    },
    only=CONTRACT,
)
