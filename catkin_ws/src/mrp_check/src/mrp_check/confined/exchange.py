# SPDX-License-Identifier: BSD-3-Clause
"""What the contract's services and examples ask of a node that runs by itself."""

import threading
import time
from typing import Any, Dict, List, Optional

import rospy

from mrp_check.confined import fitting, messages
from mrp_check.confined.observe import Observer
from mrp_check.confined.plans import DirectNode, Fields, Given, ServicePlan
from mrp_check.confined.seen import Alone, Answer

_MOST = 50  # requests, and messages on a topic, that are kept
_SENDING = 100  # messages that may wait to be sent


class Exchange:
    """Calls the services, and sends the examples, of a contract to one node.

    own: the definitions() of the package's messages
    patience: seconds after which nothing more is waited for
    """

    def __init__(
        self, plan: DirectNode, observer: Observer, own: Dict[str, List[str]], patience: float
    ) -> None:
        self.plan, self.observer, self.own, self.patience = plan, observer, own, patience
        self.up: Optional[float] = None
        self.given: Optional[int] = None  # messages that had been seen when it was sent its own
        self.publishers: Dict[str, Any] = {}
        self.answers: Dict[str, List[Answer]] = {}
        self.requests: Dict[str, List[Fields]] = {}
        self.services = [self._offer(service) for service in plan.calls]

    # --- Services

    def _offer(self, service: ServicePlan) -> Any:
        """Offer a service that the node calls, with the contract's responses."""
        kind = messages.of_service(service.type, self.own)
        asked = self.requests[service.name] = []
        if kind is None:
            return None

        def answer(request: Any) -> Any:
            fields = messages.flatten(request)
            if len(asked) < _MOST:
                asked.append(fields)
            same = (c.response for c in service.calls if fitting.fits(c.request, fields, 1e-9))
            return messages.of_fields(kind._response_class, next(same, {}))

        return rospy.Service(service.name, kind, answer)

    def _ask(self, service: ServicePlan, full: str) -> None:
        """Ask the node all that the contract says, in a thread: it may never answer."""
        answers = self.answers[service.name]
        for call in service.calls:
            try:
                kind = messages.of_service(service.type, self.own)
                request = messages.of_fields(kind._request_class, call.request)
                answer = rospy.ServiceProxy(full, kind)(request)
                answers.append(Answer(messages.flatten(answer)))
            except Exception as error:  # whatever the node makes of it
                answers.append(Answer(None, str(error)))

    # --- What it is sent

    def step(self, name: Optional[str]) -> None:
        """Go on, for a node that has this name by now."""
        if name is None:
            return
        self.up = self.up or time.monotonic()
        for service in self.plan.offers:
            full = _full(service.name, name)
            if service.name not in self.answers and self.observer.offers(name, full):
                self.answers[service.name] = []
                threading.Thread(target=self._ask, args=(service, full), daemon=True).start()
        if self.plan.example and self.given is None and self._is_ready(name):
            self.given = len(self.observer.seen.messages) if self.plan.example.gives else 0
            for given in self.plan.example.gives:
                publisher, kind = self.publishers[given.topic]
                publisher.publish(messages.of_fields(kind, given.fields))

    def _is_ready(self, name: str) -> bool:
        """Return whether the node publishes all that it should, and hears what it is to be sent."""
        example = self.plan.example
        published = {p.topic for p in list(self.observer.seen.publications) if p.node == name}
        wanted = {_full(topic, name) for topic in example.expects} if example else set()
        ends = [self._publisher(given, name) for given in example.gives] if example else []
        return wanted <= published and all(end and end.get_num_connections() for end in ends)

    def _publisher(self, given: Given, name: str) -> Any:
        if given.topic not in self.publishers:
            topic = _full(given.topic, name)
            kinds = {
                s.type
                for s in list(self.observer.seen.subscriptions)
                if (s.node, s.topic) == (name, topic)
            }
            kind = messages.of_type(given.type, self.own)
            if not kinds & {given.type, "*"} or kind is None:
                return None
            publisher = rospy.Publisher(topic, kind, queue_size=_SENDING)
            self.publishers[given.topic] = publisher, kind
        return self.publishers[given.topic][0]

    # --- What came of it

    def _replies(self, name: str) -> Dict[str, List[Fields]]:
        """Return what was published since, on the example's topics."""
        replies: Dict[str, List[Fields]] = {}
        for topic in self.plan.example.expects if self.plan.example else ():
            found = self.observer.seen.messages[self.given or 0 :]
            own = [m for m in found if (m.node, m.topic) == (name, _full(topic, name))]
            replies[topic] = [m.fields or {} for m in own[:_MOST]]
        return replies

    def is_done(self, name: str) -> bool:
        """Return whether no more has to be waited for."""
        if self.up is None or time.monotonic() - self.up > self.patience:
            return self.up is not None
        answers, example = self.answers, self.plan.example
        open_ = [s for s in self.plan.offers if len(answers.get(s.name, ())) < len(s.calls)]
        if open_ or any(not asked for asked in self.requests.values()):
            return False
        if example is None:
            return True
        if self.given is None:
            return False
        replies, rest = self._replies(name), (example.tolerance, example.is_among)
        matches = [fitting.follow(e, replies[t], *rest) for t, e in example.expects.items()]
        return None not in matches

    def result(self, result: Alone) -> None:
        """Put what came of it into the node's result."""
        result.answers = {service: [*found] for service, found in self.answers.items()}
        result.requests = {service: [*found] for service, found in self.requests.items()}
        if self.given is not None and result.name:
            result.replies = self._replies(result.name)


def _full(topic: str, name: str) -> str:
    """Return the full name of a topic, of a node of that name; ~ stands for it."""
    return topic.replace(name.rsplit("/", 1)[0] + "/~", name)
