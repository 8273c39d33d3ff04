# SPDX-License-Identifier: BSD-3-Clause
"""The requirements latch, values and rate: what a node publishes."""

from __future__ import annotations

import statistics

from mrp_check.running.observing import resolved
from mrp_check.running.words import few


def publisher_findings(node):
    """Yield a Finding for what the node publishes: nothing, latched, its values, its rate."""
    role = node.wanted.publishes
    if role is None:
        return
    messages = node.own_messages(role.topic)
    announced = resolved(role.topic, node.path) in node.topics("publications")
    if announced and not messages:
        silent = _silent_seconds(node)
        waits = _long_period(node, role)
        if silent < 6 * (role.period or 0.5):
            return  # the machine was too busy to tell
        yield node.finding(
            "values",
            f"{node.name} announces {role.topic.name}, but published nothing in {silent:.0f} s"
            + (f": a timer of it waits {waits:g} s." if waits else "."),
            node.places.of(node.name, "timer", "rate", "publish", "publisher"),
            expected=_rule_text(role) + (f", every {role.period:g} s" if role.period else ""),
            seen="no message",
        )
    if not messages:
        return
    latched = node.path in node.latched.get(messages[0]["topic"], [])
    if latched != role.latched:
        yield node.finding(
            "latch",
            f"{node.name} latches its topic: whoever subscribes later first hears an old value."
            if latched
            else f"{node.name} does not latch its topic.",
            node.places.of_topic(node.name, "publisher", role.topic.name),
            expected="a latched publisher" if role.latched else "a publisher without latch",
            seen="latched" if latched else "not latched",
        )
    values = [node.value(m, role.topic) for m in messages]
    if role.values and None not in values:
        yield from _value_findings(node, values, role)
    yield from _rate_findings(node, messages, role)


def _silent_seconds(node):
    last = max([p["time"] for p in node.of("publications")] or [0])
    return max(node.asked - last, 0)


def _long_period(node, role):
    """Return the period of a timer of the node that is far too long, or None."""
    periods = [p.values.get("period") for p in node.places.facts_of(node.name, "timer", "rate")]
    numbers = [p for p in periods if isinstance(p, (int, float))]
    return next((p for p in numbers if p > 3 * (role.period or p)), None)


def _value_findings(node, values, role):
    rule = role.values
    shown = ", ".join(map(str, values[:5]))
    expected = _rule_text(role)
    file_line = node.places.of_counter(node.name, node.counter_names())
    publish = node.places.of(node.name, "publish")
    wrong = [(a, b) for a, b in zip(values, values[1:]) if b != rule.after(a)]
    if wrong:
        before, after = wrong[0]
        if all(b == a for a, b in wrong) and len(wrong) < len(values) - 1:
            said = f"{node.name} publishes a value more than once: {shown}."
            place = publish
        elif all(b == a for a, b in zip(values, values[1:])):
            said = f"{node.name} publishes the same value again and again: {shown}."
            place = file_line
        else:
            said = f"{node.name} publishes {shown}: after {before} came {after}."
            skips = rule.step and (after - before) % rule.step == 0 and after > before
            place = skips and node.places.condition_of_publish(node.name) or file_line
        yield node.finding("values", said, place, expected=expected, seen=shown)
    elif values[0] != rule.start:
        yield node.finding(
            "values",
            f"{node.name} begins with {values[0]}, not with {rule.start}: it publishes {shown}.",
            _start_place(node, values[0], publish),
            expected=expected,
            seen=shown,
        )


def _start_place(node, first, publish):
    """Return the place at which the counter gets its first value."""
    for kind in ("counter", "start"):
        for place in node.places.facts_of(node.name, kind):
            return place.file, place.line
    if node.places.facts_of(node.name, "step"):
        place = node.places.facts_of(node.name, "step")[0]
        return place.file, place.line
    return publish


def _rate_findings(node, messages, role):
    if not role.period:
        return
    place = node.places.of(node.name, "rate", "timer", "publish")
    expected = f"a message every {role.period:g} s"
    times = [m["time"] for m in messages]
    if not node.has_rate():
        waited = node.asked - times[-1]
        if waited > 3 * role.period + 10 * node.all.get("lag", 0):
            count = "once" if len(times) == 1 else f"{len(times)} messages"
            slow = len(times) > 1 and times[-1] - times[0] > 2 * role.period
            yield node.finding(
                "rate",
                f"{node.name} published {count}"
                + (
                    " in all, far too seldom."
                    if slow
                    else f", and then no more for {waited:.0f} s."
                ),
                place,
                expected=expected,
                seen=count,
            )
        return
    gaps = [b - a for a, b in zip(times, times[1:])]
    # A busy machine can delay messages, and let them come in a burst after that; it can change
    # neither the middle one of all gaps by much, nor the time that all together take.
    middle, mean = statistics.median(gaps), (times[-1] - times[0]) / len(gaps)
    low, high = role.period * (1 - role.tolerance), role.period * (1 + role.tolerance)
    lag = node.all.get("lag", 0)
    too_fast = middle < low and mean < low
    too_slow = middle > high + 2 * lag and mean > high + 2 * lag
    if too_slow and not _is_slow_by_itself(node, role, high):
        return
    if too_fast or too_slow:
        seen = f"a message every {middle:.2g} s"
        # Beside a timer: a loop's own sleep is what its rate is made of.
        timer = "Timer" in (node.package.lines(place[0])[place[1] - 1] if place[0] else "")
        sleep = too_slow and timer and node.places.sleep_beside(node.name, "publish")
        yield node.finding(
            "rate",
            f"{node.name} publishes too {'often' if too_fast else 'seldom'}: {seen}, where the"
            f" contract says every {role.period:g} s."
            + (" Its callback sleeps, and the timer waits for it." if sleep else ""),
            sleep or place,
            expected=expected,
            seen=seen,
        )


def _is_slow_by_itself(node, role, high):
    """Return whether the node was as slow when it ran by itself: two runs agree."""
    messages = node.direct_of("messages")
    topics = {m["topic"] for m in messages if m["topic"].endswith("/" + role.topic.name)}
    times = [m["time"] for m in messages if m["topic"] in topics]
    gaps = [b - a for a, b in zip(times, times[1:])]
    return not gaps or statistics.median(gaps) > high


def relay_findings(node):
    """Yield a Finding if a node that relays publishes something else for what it is sent."""
    relay = node.wanted.relays
    if relay is None:
        return
    sent = [value for value in (node.direct or {}).get("sent", []) if value is not None]
    name = node.direct and node.direct.get("name")
    if not sent or not name:
        return
    target = resolved(relay.target, name)
    published = [m for m in node.direct_of("messages") if m["topic"] == target]
    values = [node.value(m, relay.target) for m in published]
    expected = [relay.of(value) for value in sent]
    if values == expected or None in values:
        return
    place = node.places.of(node.name, "publish", "publisher")
    if not values:
        if target not in node.topics("publications", direct=True):
            return  # another topic: said elsewhere
        said = f"{node.name} was sent {len(sent)} messages, and published none."
    else:
        said = f"{node.name} was sent {few(sent)}, and published {few(values)}."
    yield node.finding(
        "values", said, place, expected=few(expected), seen=few(values) or "no message"
    )


def _rule_text(role):
    rule = role.values
    if not rule:
        return f"messages on {role.topic.name}"
    values = [rule.start, rule.start + rule.step, rule.start + 2 * rule.step]
    return ", ".join(map(str, values)) + ", ..."
