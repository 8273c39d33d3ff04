# SPDX-License-Identifier: BSD-3-Clause
"""Publishers publish the right values, and those wrap round past the largest one."""

from __future__ import annotations

from typing import Iterator, Sequence

from mrp_check.confined.places import Kind
from mrp_check.confined.plans import TOLD
from mrp_check.confined.seen import Message, Number
from mrp_check.contract.finding import HINT, Finding
from mrp_check.contract.requirements import CONTRACT, Requirement, Rule
from mrp_check.contract.spec import Publishes, Values
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.run.node import Node, each_node
from mrp_check.run.planning import resolved
from mrp_check.run.words import few


def _of(node: Node) -> Iterator[Finding]:
    yield from _relayed(node)
    role = node.wanted.publishes
    if role is None:
        return
    messages = node.published()
    topic = resolved(role.topic, node.path)
    if topic in node.topics(Kind.PUBLISHER) and not messages and node.wanted.of_itself:
        advertised = max([publication.time for publication in node.seen.publications] or [0])
        silent = max(node.asked - advertised, 0)
        periods = [place.period for place in node.places.facts.of(node.name, Kind.TIMER)]
        numbers = [period for period in periods if isinstance(period, (int, float))]
        # Of a timer that is far too slow.
        waits = next((period for period in numbers if period > 3 * (role.period or period)), None)
        if node.is_unheard(topic) or silent * (1 - node.waited) < 6 * (role.period or 0.5):
            return  # the machine was too busy to tell
        if node.published(alone=True):
            return  # by itself it published: two runs do not agree
        yield node.finding(
            "values",
            f"{node.name} advertises {role.topic.name}, but published nothing in {silent:.0f} s"
            + (f": a timer of it waits {waits:g} s." if waits else "."),
            node.places.of(node.name, Kind.TIMER, Kind.PUBLISH, Kind.PUBLISHER),
            expected=_rule_text(role) + (f", every {role.period:g} s" if role.period else ""),
            seen="no message",
        )
    for text in node.wrong_texts()[:1]:
        yield node.finding(
            "values",
            f"{node.name} publishes “{text}”, where the contract says “{role.topic.text}”.",
            node.places.of_text(node.name, text) or node.places.of(node.name, Kind.PUBLISH),
            expected=f"{role.topic.text}, with a number for {{value}}",
            seen=text,
        )
    # A mistake shows in both runs, or only in the longer one.
    found = (_wrong_numbers(node, role, messages) for messages in node.runs())
    yield from next(filter(None, found), [])


def _wrong_numbers(node: Node, role: Publishes, messages: Sequence[Message]) -> list[Finding]:
    values = [node.value(message, role.topic) for message in messages]
    numbers = [value for value in values if value is not None]
    if not numbers or len(numbers) < len(values):
        return []
    wrong = [*_value_findings(node, numbers, role.values, _rule_text(role))] if role.values else []
    return wrong + ([*_not_rising(node, numbers, _rule_text(role))] if role.rises else [])


def _not_rising(node: Node, values: Sequence[Number], expected: str) -> Iterator[Finding]:
    wrong = next(((a, b) for a, b in zip(values, values[1:]) if b <= a), None)
    if wrong:
        yield node.finding(
            "values",
            f"{node.name} publishes {few(values)}: after {wrong[0]:g} came {wrong[1]:g}.",
            node.places.of(node.name, Kind.PUBLISH),
            expected=expected,
            seen=few(values),
        )


def _value_findings(
    node: Node, values: Sequence[Number], rule: Values, expected: str
) -> Iterator[Finding]:
    shown = ", ".join(map(str, values[:5]))
    file_line = node.places.of_counter(node.name, node.counter_names())
    publish = node.places.of(node.name, Kind.PUBLISH)
    wrong = [(a, b) for a, b in zip(values, values[1:]) if b != rule.after(a)]
    if wrong:
        before, after = wrong[0]
        if all(b == a for a, b in wrong) and len(wrong) < len(values) - 1:
            sentence = f"{node.name} publishes a value more than once: {shown}."
            place = publish
        elif all(b == a for a, b in zip(values, values[1:])):
            sentence = f"{node.name} publishes the same value again and again: {shown}."
            place = file_line
        else:
            sentence = f"{node.name} publishes {shown}: after {before} came {after}."
            skips = rule.step and (after - before) % rule.step == 0 and after > before
            place = skips and node.places.condition_of_publish(node.name) or file_line
        yield node.finding("values", sentence, place, expected=expected, seen=shown)
    elif values[0] != rule.start:
        facts = node.places.facts
        places = facts.of(node.name, Kind.COUNTER) or facts.of(node.name, Kind.STEP)
        yield node.finding(
            "values",
            f"{node.name} begins with {values[0]}, not with {rule.start}: it publishes {shown}.",
            (places[0].file, places[0].line) if places else publish,
            expected=expected,
            seen=shown,
        )


def _relayed(node: Node) -> Iterator[Finding]:
    """Yield a Finding if a node that relays publishes something else for what it is sent."""
    relay = node.wanted.relays
    if relay is None:
        return
    sent = node.sent()
    name = node.own_name
    if not sent or not name:
        return
    target = resolved(relay.target, name)
    published = [message for message in node.seen_alone.messages if message.topic == target]
    values = [node.value(message, relay.target) for message in published]
    expected = [relay.of(value) for value in sent]
    if values == expected or None in values:
        return
    place = node.places.of(node.name, Kind.PUBLISH, Kind.PUBLISHER)
    if not values:
        if target not in node.topics(Kind.PUBLISHER, alone=True) or node.is_unheard(target):
            return  # another topic: said elsewhere; or nobody knows
        sentence = f"{node.name} was sent {len(sent)} messages, and published none."
    else:
        sentence = f"{node.name} was sent {few(sent)}, and published {few(values)}."
    yield node.finding(
        "values", sentence, place, expected=few(expected), seen=few(values) or "no message"
    )


def _rule_text(role: Publishes) -> str:
    rule = role.values
    if role.rises:
        return "numbers, each larger than the one before"
    if not rule:
        return f"messages on {role.topic.name}"
    values = [rule.start, rule.start + rule.step, rule.start + 2 * rule.step]
    return ", ".join(map(str, values)) + ", ..."


_published = evidence.of_publisher(
    lambda role: role.values or role.rises, Node.published_numbers, "published no number"
)
_sent = evidence.when(Node.sent, "was sent nothing", lambda wanted: wanted.relays)


_FEW_STEPS = 20  # near its first value, a counter has made no more


def _wrap(node: Node) -> Iterator[Finding]:
    """Yield a Finding if a Python publisher goes wrong at the end of its numbers."""
    rule = node.wanted.publishes.values if node.wanted.publishes else None
    if not (rule and rule.modulus and node.wrap):
        return
    events = {event.event: event for event in node.wrap.events}
    last = rule.start + (rule.modulus - 1 - rule.start) // rule.step * rule.step
    expected = f"after {last} comes {rule.after(last)}, modulo {rule.modulus}"
    power = rule.modulus.bit_length() - 1
    if rule.modulus == 2**power:
        expected += f" (2^{power})"
    if "not_found" in events:
        yield _unchecked(node, last, expected, "wasn't found")
    elif "error" in events:
        text = events["error"].text
        yield node.finding(
            "wrap",
            f"{node.name} stops publishing when its counter goes past {rule.modulus - 1}: {text}",
            node.places.of_counter(node.name, node.counter_names()),
            expected=expected,
            seen=text,
        )
    elif "set" in events:
        values = [event.value for event in node.wrap.events if event.event == "after"]
        after = [value for value in values if value is not None]
        yield from _at_the_end(node, rule, last, after, expected)


def _at_the_end(
    node: Node, rule: Values, last: int, after: Sequence[Number], expected: str
) -> Iterator[Finding]:
    """Yield a Finding about the values that are published after the counter was set."""
    if not after:
        return
    if after[0] not in (last, rule.after(last)):
        # What was set had no effect: the values go on from where they were. Or it wraps too early.
        is_near_start = after[0] < rule.start + _FEW_STEPS * abs(rule.step)
        if is_near_start and (after[0] - rule.start) % rule.step == 0:
            yield _unchecked(node, last, expected, "couldn't be set")
        else:
            yield _wrap_finding(node, rule, after, expected)
        return
    rest = after[after.index(last) + 1 :] if last in after else after
    good = (rule.after(last), rule.start)
    if rest and rest[0] not in good or not rest and len(after) < TOLD:
        yield _wrap_finding(node, rule, after, expected)


def _unchecked(node: Node, last: int, expected: str, why: str) -> Finding:
    return node.finding(
        "wrap",
        f"Couldn't check what {node.name} publishes after {last}: its counter {why}.",
        node.places.of(node.name, Kind.PUBLISH),
        HINT,
        expected=expected,
    )


def _wrap_finding(node: Node, rule: Values, after: Sequence[Number], expected: str) -> Finding:
    largest, names = (rule.modulus or 1) - 1, node.counter_names()
    near_start = rule.start + _FEW_STEPS * abs(rule.step)
    wrong = next((value for value in after if value % (largest + 1) < near_start), None)
    shown = ", ".join(map(str, after))
    return node.finding(
        "wrap",
        f"Near its largest number, {largest}, {node.name} publishes {shown}.",
        node.places.of_counter(node.name, names, wrong),
        expected=expected,
        seen=shown,
    )


def _findings(case: Case) -> Iterator[Finding]:
    yield from each_node(_of, each_topic=True)(case)
    yield from each_node(_wrap)(case)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=_findings,
    requirements={
        "values": Requirement(
            "Publishers publish the right values",
            "publisher",
            lambda case: _sent(case) or _published(case),
        ),
        "wrap": Requirement(
            "The values wrap around after the largest one",
            "publisher",
            evidence.of_publisher(
                lambda role: role.values and role.values.modulus,
                Node.has_wrapped,
                "has no counter that could be found",
            ),
        ),
    },
    only=CONTRACT,
)
