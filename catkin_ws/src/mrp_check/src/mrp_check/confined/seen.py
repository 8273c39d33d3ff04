# SPDX-License-Identifier: BSD-3-Clause
"""What session.py has seen: a LaunchResult or a DirectResult.

Times are in seconds, from the moment on at which roslaunch, or each node, was started.
"""

import dataclasses
import typing
from typing import Dict, List, Optional, Tuple

Number = typing.Union[int, float]
Plain = typing.Union[bool, int, float, str]
OutputLine = Tuple[float, str, str]  # its time, its stream ("out" or "err"), its text
_AFTER = 0.5  # seconds in which roslaunch may still show what was printed before it was to end


@dataclasses.dataclass
class Registration:
    """A node has announced to the master that it publishes or subscribes.

    heard: whether the observer was connected to a publisher; if not, nothing is known of what it
        publishes
    answered: when the node had the master's answer: before, it has published nothing
    """

    node: str
    topic: str
    type: str
    time: float
    heard: bool = True
    answered: float = 0.0


@dataclasses.dataclass(frozen=True)
class Message:
    """A message, by the one who sent it.

    fields: path such as "data" or "header.seq" -> number or text; None if it cannot be read
    """

    node: str
    topic: str
    fields: Optional[Dict[str, Plain]]
    time: float


@dataclasses.dataclass(frozen=True)
class Log:
    """A line that a node has logged, and where in its source. level: DEBUG, INFO, WARN, ..."""

    node: str
    level: str
    text: str
    file: str
    line: int
    time: float


@dataclasses.dataclass
class Seen:
    """What came to the observer, in order. lag: how late it was itself, as Observer.lag() says.

    services: what nodes offer; lookups: what they look for, each without its type
    """

    publications: List[Registration] = dataclasses.field(default_factory=list)
    subscriptions: List[Registration] = dataclasses.field(default_factory=list)
    messages: List[Message] = dataclasses.field(default_factory=list)
    logs: List[Log] = dataclasses.field(default_factory=list)
    lag: float = 0.0
    services: List[Registration] = dataclasses.field(default_factory=list)
    lookups: List[Registration] = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Event:
    """What hook/sitecustomize.py tells of a Python node, in which the node could write, too.

    event: one of those that its docstring names; the rest is what such an event has
    """

    event: str
    file: Optional[str] = None
    line: Optional[int] = None
    topic: Optional[str] = None
    names: Optional[List[str]] = None
    value: Optional[Number] = None
    text: str = ""


@dataclasses.dataclass
class Left:
    """A process that is still there after the end; node: the key of the node that left it."""

    command: str
    node: Optional[str]


@dataclasses.dataclass
class LaunchResult:
    """What came of a LaunchPlan.

    ending: why no more was waited for: "enough" was seen, roslaunch ended "itself", or "time" or
        "most" had passed
    asked: when roslaunch was asked to end; stopped_in: after which time it did, if it did
    code: its exit code (negative: killed by that signal), if it had ended before it was asked to
    latched: topic -> the nodes that latch it
    waited: node -> which part of the time in which it published it waited for a processor
    uncalled: the roscpp nodes of which no subscriber's callback was called, as far as that is seen
    lines: what it printed
    """

    ending: str
    asked: float
    lines: List[OutputLine]
    seen: Seen
    code: Optional[int] = None
    stopped_in: Optional[float] = None
    left: List[Left] = dataclasses.field(default_factory=list)
    latched: Dict[str, List[str]] = dataclasses.field(default_factory=dict)
    waited: Dict[str, float] = dataclasses.field(default_factory=dict)
    uncalled: List[str] = dataclasses.field(default_factory=list)

    def until_asked(self, after: float = _AFTER) -> List[str]:
        """Return the lines that were printed before it was asked to end, or just then.

        after: how long after that; 0 for what the nodes say, which may follow from being asked
        """
        return [text for time, _, text in self.lines if time <= self.asked + after]


@dataclasses.dataclass
class Answer:
    """What a service answered; None, and the reason, if it did not."""

    fields: Optional[Dict[str, Plain]]
    error: str = ""


@dataclasses.dataclass
class Alone:
    """What came of a DirectNode.

    name: its own, as it registered; None if it did not
    sent: the values that it was sent; None for what could not be sent
    code: its exit code (negative: killed by that signal); None if it never ended
    asked: when it was asked to end, if it still ran; stopped_in: after which time it did then
    ended_after: when it ended without being asked
    killed: whether it had to be
    still_registered: whether the master still knew it after its end
    busy: which part of the time its busiest thread ran, or would have if it had had a processor,
        since it had registered and until it was asked to end; None if that was too short
    lines: what it printed, as far as it is kept; line_count: of all that it printed
    answers: full name of a service -> what it answered to each call that was made
    requests: the same of a service that it calls -> what it asked
    replies: topic -> what it published in its example; None if it was not sent its messages
    """

    name: Optional[str] = None
    sent: List[Optional[int]] = dataclasses.field(default_factory=list)
    code: Optional[int] = None
    asked: Optional[float] = None
    stopped_in: Optional[float] = None
    ended_after: Optional[float] = None
    killed: bool = False
    still_registered: bool = False
    busy: Optional[float] = None
    events: List[Event] = dataclasses.field(default_factory=list)
    lines: List[OutputLine] = dataclasses.field(default_factory=list)
    line_count: int = 0
    answers: Dict[str, List[Answer]] = dataclasses.field(default_factory=dict)
    requests: Dict[str, List[Dict[str, Plain]]] = dataclasses.field(default_factory=dict)
    replies: Optional[Dict[str, List[Dict[str, Plain]]]] = None


@dataclasses.dataclass
class DirectResult:
    """What came of a DirectPlan. nodes: by the keys of the plan; latched: as of a LaunchResult"""

    nodes: Dict[str, Alone] = dataclasses.field(default_factory=dict)
    left: List[Left] = dataclasses.field(default_factory=list)
    seen: Seen = dataclasses.field(default_factory=Seen)
    latched: Dict[str, List[str]] = dataclasses.field(default_factory=dict)
