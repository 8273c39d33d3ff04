# SPDX-License-Identifier: BSD-3-Clause
"""What session.py is asked to observe: a LaunchPlan or a DirectPlan. Times are in seconds."""

import dataclasses
from typing import Dict, List, Optional, Union

Plain = Union[bool, int, float, str]
TOLD = 3  # messages of a Wrap
Fields = Dict[str, Plain]  # of a message, each by its path, such as "linear.x"


@dataclasses.dataclass
class Common:
    """What both kinds of plan have.

    environment: of the nodes, and of roslaunch
    writable: the folders that these may write to
    messages: what messages.definitions() says of the package's own
    silence: after so long without a message no more is waited for
    seconds: what it may take to see enough, once all nodes are up
    most: what it may take in all
    stop_seconds: what ending may take
    """

    environment: Dict[str, str]
    writable: List[str]
    messages: Dict[str, List[str]]
    silence: float
    seconds: float
    most: float
    stop_seconds: float


@dataclasses.dataclass
class LaunchNode:
    """A node of the spec that a launch file starts.

    path: its full name
    type: package/executable, if the launch file is the package's
    publishes: whether it publishes
    received: the regular expression of the line that it logs for each value, if it logs one
    hears: the topic that it subscribes to, if there is one; senders: how many nodes publish there
    is_cpp: whether it may make the file of hook/callbacks.cpp
    """

    path: str
    type: Optional[str]
    publishes: bool
    received: Optional[str]
    hears: Optional[str]
    senders: int
    is_cpp: bool = False


@dataclasses.dataclass
class LaunchPlan:
    """The nodes are started by a launch file, and ended by Ctrl-C to roslaunch.

    command: of roslaunch
    nodes: those of the spec
    enough: messages of each publisher, and of each publisher at each subscriber
    """

    common: Common
    command: List[str]
    nodes: List[LaunchNode]
    enough: int


@dataclasses.dataclass
class Wrap:
    """The values that a Python publisher should publish: it is run near the end of them.

    field: of the message; start, step, modulus: those of a spec.Values
    told: messages of which the hook tells after it has set the counter to the last value but one
    """

    field: str
    start: int
    step: int
    modulus: int
    told: int


@dataclasses.dataclass
class Hook:
    """What hook/sitecustomize.py has to know.

    folder: its own; events: the file that it writes; sources: the folder of the package's code
    """

    folder: str
    events: str
    sources: str
    wrap: Optional[Wrap] = None


@dataclasses.dataclass
class CallPlan:
    """What a service is asked, and what it should answer."""

    request: Fields
    response: Fields


@dataclasses.dataclass
class ServicePlan:
    """A service of the contract; name: its full one."""

    name: str
    type: str
    calls: List[CallPlan]


@dataclasses.dataclass
class Given:
    """A message that a node is sent; topic: its full name."""

    topic: str
    type: str
    fields: Fields


@dataclasses.dataclass
class ExamplePlan:
    """What a node is sent, and what it should publish then: full name of a topic -> messages.

    is_among: whether they may come after others; tolerance: how much numbers may differ
    """

    gives: List[Given]
    expects: Dict[str, List[Fields]]
    is_among: bool
    tolerance: float


@dataclasses.dataclass
class DirectNode:
    """A node that is started by itself, as rosrun would.

    namespace: its own
    env: of it alone; params: full name of a parameter -> its value
    publishes: how many messages of it are enough; 0 if it publishes nothing by itself
    relays: whether it publishes one for each that it is sent, and none by itself
    values: what it is sent at once; paced: what it is sent then, one by one
    field, type: of the messages in which it is sent these; None if it is sent nothing
    topic: the last part of its name
    text: what the field says, with {value} in the value's place; None: the value itself
    received: as of a LaunchNode
    hook: of a Python node
    offers: the services that it is asked; calls: those that it is answered
    example: what it is run for, and nothing else; None for the run that shows all the rest
    """

    command: List[str]
    namespace: str
    env: Dict[str, str]
    params: Dict[str, object]
    publishes: int
    values: List[int]
    paced: List[int]
    field: Optional[str]
    text: Optional[str]
    type: Optional[str]
    received: Optional[str]
    hook: Optional[Hook]
    topic: Optional[str] = None
    relays: bool = False
    offers: List[ServicePlan] = dataclasses.field(default_factory=list)
    calls: List[ServicePlan] = dataclasses.field(default_factory=list)
    example: Optional[ExamplePlan] = None

    @property
    def is_wrap(self) -> bool:
        """Whether it is run near the end of its numbers, for nothing else."""
        return self.hook is not None and self.hook.wrap is not None


@dataclasses.dataclass
class DirectPlan:
    """Each node is started by itself, in a namespace of its own; each subscriber is sent messages;
    then each node is sent the signal.

    nodes: key -> DirectNode
    """

    common: Common
    nodes: Dict[str, DirectNode]
    signal: int
