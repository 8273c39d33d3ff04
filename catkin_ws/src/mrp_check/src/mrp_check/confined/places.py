# SPDX-License-Identifier: BSD-3-Clause
"""What a source says: its Places; and what cpp_facts.py prints."""

import dataclasses
import enum
import re
from typing import List, Optional, Union

Plain = Union[bool, int, float, str, None]  # a value that a source says plainly

# What a text may name: a path in somebody's home folder; a device, another computer, or a screen.
HOME = re.compile(r"/(?:home|Users)/(?![A-Z_]+/)[\w.-]+/[^\s\"'<>;:]*")
ELSEWHERE = re.compile(
    r"/dev/\w|\bserial\b|VideoCapture|(?i:\bdisplay\b)|(?<![\d.])\d{1,3}(\.\d{1,3}){3}(?![\d.])"
)


class Kind(enum.Enum):
    """What stands at a place."""

    INIT = "init"
    PUBLISHER = "publisher"
    SUBSCRIBER = "subscriber"
    PUBLISH = "publish"
    TIMER = "timer"
    COUNTER = "counter"  # the first value of what is counted
    STEP = "step"  # its change
    DATA = "data"  # a message's field is set
    LOG = "log"
    PRINT = "print"
    SPIN = "spin"
    LOOP = "loop"
    SLEEP = "sleep"
    EXIT = "exit"
    SIGNAL = "signal"
    FUNCTION = "function"
    # Services, actions and parameters that are named:
    ASKS = "asks"  # for a service
    WAITS = "waits"  # until a service or an action's server is there
    OFFERS = "offers"  # a service
    COMMANDS = "commands"  # an action
    SERVES = "serves"  # an action
    READS = "reads"  # a parameter
    ENDS = "ends"  # a goal
    # Other programs:
    STARTS = "starts"  # a process
    KILLS = "kills"  # a process
    # What may go wrong:
    GOAL_LOOP = "goal loop"  # of an action's server, which does not ask whether it is cancelled
    IGNORED = "ignored"  # what a call returns that can fail
    KEYBOARD = "keyboard"  # somebody has to type
    ARGUMENTS = "arguments"  # of the command line are read
    ELSEWHERE = "elsewhere"  # a device, another computer or a screen is used
    PATH = "path"  # a text that names a home folder
    # In C++ alone:
    HANDLE = "handle"
    GLOBAL = "global"  # a handle at file scope
    OWNER = "owner"  # of a handle, at file scope
    DISCARDED = "discarded"  # made, and kept nowhere
    LOCAL = "local"  # made, and kept in what ends too soon


@dataclasses.dataclass
class Place:
    """Something in a source. What the source does not say plainly is None.

    file: relative to the package
    line: from 1
    text: the constant text, such as a topic's or a node's name, or a line that is logged with {}
        for each value in it; of others the name of what is called, or of a variable or its type
    end: the last line of a function or a loop; unused: whether nothing names it; usr: clang's name
        for it
    queue, queue_line: its length, and where that stands
    period: seconds of a timer; oneshot: whether it fires once
    anonymous: whether a node asks for such a name
    type, bits: of a counter
    names: of the variables that a message's field is set from
    value: the exit code that is returned
    latch: whether a publisher latches, or may
    name: of a handle's variable; function: the one at whose end that variable ends
    holds: the types of the handles in it
    """

    file: str
    line: int
    kind: Kind
    text: Optional[str] = None
    end: int = 0
    unused: Optional[bool] = None
    usr: Optional[str] = None
    queue: Plain = None
    queue_line: Optional[int] = None
    period: Plain = None
    oneshot: Plain = None
    anonymous: Plain = None
    type: str = ""
    bits: int = 0
    names: List[str] = dataclasses.field(default_factory=list)
    value: int = 0
    latch: bool = False
    name: Optional[str] = None
    function: Optional[str] = None
    holds: List[str] = dataclasses.field(default_factory=list)

    @property
    def base(self) -> str:
        """The name's last part: whatever namespace it is in."""
        return (self.text or "").strip("~/").rpartition("/")[2]

    def is_around(self, place: "Place") -> bool:
        """Return whether this is a function, or a loop, in which another place is."""
        within = self.line <= place.line <= self.end
        return self.kind in (Kind.FUNCTION, Kind.LOOP) and self.file == place.file and within


@dataclasses.dataclass
class Said:
    """What a C++ source says. errors: what clang says against it; named: functions that it names"""

    places: List[Place] = dataclasses.field(default_factory=list)
    errors: List[str] = dataclasses.field(default_factory=list)
    named: List[str] = dataclasses.field(default_factory=list)
