# SPDX-License-Identifier: BSD-3-Clause
"""Each node by itself: it is sent messages, and the signal that it is to end on."""

import re
import signal
import time
from typing import Dict, List, Optional

import rospy

from mrp_check.confined import apart, crossing, messages, variables, written
from mrp_check.confined.activity import (
    BUSY,
    TICK,
    Activity,
    is_over,
    processor_seconds,
    runnable,
    wait,
)
from mrp_check.confined.exchange import Exchange
from mrp_check.confined.observe import Observer
from mrp_check.confined.plans import TOLD, Common, DirectNode, DirectPlan
from mrp_check.confined.program import Program, left_behind
from mrp_check.confined.seen import Alone, DirectResult, Event

_PACE = 1.0  # seconds after which the next value is sent, though the last one was not logged
_ENDING = 90.0  # seconds after which not even a busy node is waited for
_STACK_SECONDS = 1.0  # that a stuck node gets to print where it stands
_SENDING = 100  # messages that may wait to be sent
_RECENT = 100  # lines in which one that was just logged is looked for
# What a node subscribes to by itself.
_OF_ROS = ("/clock", "/tf", "/tf_static")
_STARTING = 0.5  # seconds after it has registered in which a node may still be starting
_WATCHED = 1.5  # seconds, at least, in which it is seen how busy it is


def run(plan: DirectPlan, observer: Observer, starter: apart.Starter) -> DirectResult:
    """Run the nodes until they have done enough, and end them."""
    began, activity = time.monotonic(), Activity(observer)
    given = observer, starter, activity
    nodes = [RunningNode(key, planned, plan.common, *given) for key, planned in plan.nodes.items()]

    def send() -> None:
        for node in nodes:
            node.watch()
            node.send()
            node.send_paced()
            node.exchange.step(node.name())

    wait(plan.common, nodes, RunningNode.is_up, RunningNode.is_settled, send)
    observer.ask_types()
    latched = observer.latched()
    observer.release()
    running = [node for node in nodes if node.program.poll() is None]
    for node in running:
        node.end(signal.SIGKILL if node.plan.is_wrap or node.plan.example else plan.signal)
    while any([node.is_ending(plan.common.stop_seconds) for node in running]):
        time.sleep(TICK)
    results = {node.key: node.result() for node in nodes}
    stuck = [node for node in nodes if results[node.key].killed]
    # The hook then prints where the node stands; and where each thread does, which may end it.
    for number in (signal.SIGUSR1, signal.SIGUSR2) if stuck else ():
        for node in stuck:
            if node.plan.hook:
                node.program.send(number)
        time.sleep(_STACK_SECONDS)
    for node in stuck:
        node.program.kill()
    left = left_behind({node.key: node.program for node in nodes})
    for node in (node for node in nodes if node.program.was_executed()):
        result, program = results[node.key], node.program
        result.code, result.lines = program.poll(), program.all_lines()
        result.line_count = program.line_count
    return DirectResult(results, left, observer.seen_since(began), latched)


class RunningNode:
    """A node that is started by itself."""

    def __init__(
        self,
        key: str,
        plan: DirectNode,
        session: Common,
        observer: Observer,
        starter: apart.Starter,
        activity: Activity,
    ) -> None:
        self.key, self.plan, self.observer, self.activity = key, plan, observer, activity
        self.messages, self.silence = session.messages, session.silence
        self.sent: List[Optional[int]] = []
        self.sent_at = 0.0
        self.asked: Optional[float] = None
        self.was_registered = False
        self.registered: Optional[float] = None  # when it was first seen so
        self.began: Dict[str, float] = {}  # what its threads had run when it had started
        self.busy: Optional[float] = None
        self.publisher: Optional[rospy.Publisher] = None
        for name, value in plan.params.items():
            rospy.set_param(name, value)
        self.exchange = Exchange(plan, observer, session.messages, session.silence)
        env = {**session.environment, **plan.env, variables.NAMESPACE: plan.namespace}
        env[variables.MASTER] = observer.uri
        if plan.hook:
            env[variables.HOOK] = crossing.to_json(plan.hook)
            env[variables.PYTHONPATH] = f"{plan.hook.folder}:{env[variables.PYTHONPATH]}"
        self.program = Program(starter, plan.command, env, session.writable)

    def name(self) -> Optional[str]:
        """Return the node's own name, or None as long as it has not registered."""
        inside, seen = self.plan.namespace + "/", self.observer.seen
        records = seen.publications + seen.subscriptions + seen.services
        names = [record.node for record in records]
        return next((name for name in names if name.startswith(inside)), None)

    def watch(self) -> None:
        """Look when the node has started."""
        now = time.monotonic()
        if self.registered is None and self.name():
            self.registered = now
        if self.registered and not self.began and now - self.registered > _STARTING:
            self.registered, self.began = now, runnable(self.program.pid)

    def _is_watched(self) -> bool:
        """Return whether it is known how busy the node is."""
        return bool(self.began) and time.monotonic() - (self.registered or 0) > _WATCHED

    # --- What it is sent

    def send(self) -> None:
        """Send the plan's values, once, as soon as the node has subscribed."""
        name = self.name()
        if self.sent or not self.plan.values or name is None:
            return
        own = [
            registration
            for registration in self.observer.seen.subscriptions
            if registration.node == name
        ]
        topics = [record for record in own if record.topic not in _OF_ROS]
        # Of several, the one of the contract's type first, and of these that of its name.
        topics.sort(key=lambda record: not record.topic.endswith(f"/{self.plan.topic}"))
        topics.sort(key=lambda record: record.type != self.plan.type)
        if not topics:
            return
        if self.publisher is None:
            kind = topics[0].type if topics[0].type != "*" else self.plan.type
            self.message_class = messages.of_type(kind, self.messages)
            if self.message_class is None:
                self.sent = [None]
                return
            self.publisher = rospy.Publisher(
                topics[0].topic, self.message_class, queue_size=_SENDING
            )
        if self.publisher.get_num_connections() == 0:
            return
        for value in self.plan.values:
            self._send_one(self.publisher, value)

    def _send_one(self, publisher: rospy.Publisher, value: int) -> None:
        try:
            message = self.message_class()
            text = self.plan.text
            content = text.replace("{value}", str(value)) if text else value
            messages.set_field(message, self.plan.field or "", content)
            publisher.publish(message)
        except Exception:  # another type than the contract's
            pass
        self.sent.append(value)
        self.sent_at = time.monotonic()

    def send_paced(self) -> None:
        """Send the values that come one by one: each when the one before was logged or relayed, or
        was not for a while."""
        pending = self.plan.paced[max(len(self.sent) - len(self.plan.values), 0) :]
        if self.publisher is None or not self.sent or not pending:
            return
        name = self.name()
        if self.plan.relays:
            has_answered = self.observer.most_of(name or "") >= len(self.sent)
        else:
            number = re.compile(rf"(?<!\d){self.sent[-1]}(?!\d)")
            recent = [log for log in self.observer.seen.logs[-_RECENT:] if log.node == name]
            has_answered = any(number.search(log.text) for log in recent)
        if has_answered or is_over(time.monotonic() - self.sent_at, _PACE):
            self._send_one(self.publisher, pending[0])

    # --- Whether it is waited for

    def is_up(self) -> bool:
        if self.program.poll() is not None:
            return True
        return self.activity.is_up_or_stuck(self.name(), self.program.pid)

    def is_settled(self) -> bool:
        """Return whether no more has to be waited for from the node."""
        if self.program.poll() is not None:
            return True
        now, name = time.monotonic(), self.name()
        if name is None:  # not asked twice: by then it may have come up, and is not settled
            return self.activity.is_stuck(self.program.pid)
        if self.plan.example or not self.exchange.is_done(name):
            return self.exchange.is_done(name)
        if not self.plan.is_wrap and not self._is_watched():
            return False
        if self._is_to_be_sent(name):
            return False
        last = max(self.activity.last(name) or now, self.sent_at)
        if now - last > self.silence and self.activity.is_idle(self.program.pid):
            return True
        if self.plan.is_wrap:
            names = [event.event for event in self.events()]
            return names.count("after") >= TOLD or "error" in names or "not_found" in names
        if self.observer.most_of(name) < self.plan.publishes:
            return False
        if self.plan.values:
            return self._has_heard(name)
        return bool(self.plan.publishes) or self.activity.is_calm(name)

    def _is_to_be_sent(self, name: str) -> bool:
        """Return whether it waits for messages of this process, which a busy machine may hold up:
        they are sent once the two are connected."""
        if self.publisher is None or self.sent:
            return False
        return self.observer.is_subscribed(name, self.publisher.resolved_name)

    def _has_heard(self, name: str) -> bool:
        """Return whether the node has logged all that it was sent, if it is to log it."""
        if not self.sent or not self.plan.received:
            return bool(self.sent)
        pattern = re.compile(self.plan.received)
        logs = [log for log in list(self.observer.seen.logs) if log.node == name]
        heard = [log for log in logs if pattern.search(log.text)]
        return len(heard) >= len(self.plan.values) + len(self.plan.paced)

    # --- Its end

    def end(self, number: int) -> None:
        """Send it the signal that it is to end on."""
        self.was_registered = self._is_registered()
        self.asked = time.monotonic()
        if self._is_watched():
            ran = runnable(self.program.pid)
            used = [ran[thread] - self.began.get(thread, 0) for thread in ran]
            self.busy = max(used, default=0) / (self.asked - (self.registered or 0))
        self.program.send(number)

    def is_ending(self, seconds: float) -> bool:
        """Return whether it was asked to end, and may still be about to.

        seconds: that it may take; on a busy machine it may take longer, while it does something
        """
        if self.program.poll() is not None or self.asked is None:
            return False
        idle = self.activity.is_idle(self.program.pid)  # asked each time, so that it knows
        since = time.monotonic() - self.asked
        used = processor_seconds(self.program.pid) or 0
        return not is_over(since, seconds) or not idle and used < BUSY and since < _ENDING

    def result(self) -> Alone:
        """Return what is known of its end, but for its output."""
        result = Alone(self.name(), self.sent)
        self.program.poll()
        if not self.program.was_executed():
            return result
        began, ended = self.program.started, self.program.ended
        if self.asked is None:
            result.ended_after = ended and ended - began
        else:
            result.asked = self.asked - began
            result.stopped_in = ended and ended - self.asked
            result.killed = ended is None
        result.still_registered = self.was_registered and self._is_registered()
        result.busy = self.busy
        result.events = self.events()
        self.exchange.result(result)
        return result

    def _is_registered(self) -> bool:
        name = self.name()
        return name is not None and self.observer.is_registered(name)

    def events(self) -> List[Event]:
        """Return what the hook has reported so far, without what the node itself has put there."""
        if not self.plan.hook:
            return []
        try:
            lines = written.read(self.plan.hook.events).splitlines()
        except OSError:
            return []  # it has not written any yet
        events = []
        for line in lines:
            try:
                events.append(crossing.from_json(Event, line))
            except crossing.CrossingError:
                continue  # not yet whole
        return events
