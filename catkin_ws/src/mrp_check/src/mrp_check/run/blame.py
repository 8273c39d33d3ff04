# SPDX-License-Identifier: BSD-3-Clause
"""How sure it is that a package is to blame for an error, or for the end of a node, that was seen.

A contract says what a node must do. Without one,
1. some errors are mistakes in the code, wherever it runs: a name that doesn't exist, a call that
   doesn't fit what is called, invalid memory;
2. under a launch file of its own package, a node has all that its author gives it. What else ends
   it there is the package's fault, too, unless it needs what no package can give: a device, an
   address, a screen, somebody who types, or what another package offers;
3. started in any other way, a node may lack what its user or its launch file would give it. Nobody
   says that it must run so.
"""

from __future__ import annotations

import re
import signal
from typing import Iterator, NamedTuple

from mrp_check.confined.places import ELSEWHERE, Kind
from mrp_check.contract.finding import HABIT, HINT, SEEN
from mrp_check.run.case import Case
from mrp_check.run.observing import Launched

# Classes of Python and of C++, without namespaces, and without modules if they have a capital.
_MISTAKES = {
    *("SyntaxError", "IndentationError", "TabError", "NameError", "UnboundLocalError"),
    *("AttributeError", "TypeError", "ImportError", "ModuleNotFoundError", "RecursionError"),
    *("SerializationError", "ROSSerializationException", "ROSInitException"),
    *("InvalidNameException", "InvalidNodeNameException", "ConflictingSubscriptionException"),
    *("bad_function_call", "bad_cast"),
}
_OF_OTHERS = {
    *("OSError", "IOError", "FileNotFoundError", "PermissionError", "ConnectionRefusedError"),
    *("ConnectionResetError", "TimeoutError", "BlockingIOError", "SerialException"),
    *("TclError", "ROSInterruptException", "ROSException", "ResourceNotFound", "system_error"),
    *("socket.gaierror", "socket.timeout", "pygame.error"),
}
_OF_FRAMES = {"LookupException", "ConnectivityException", "TransformException"}
_BY_USER = {"EOFError", "termios.error", "_curses.error", "KeyboardInterrupt"}
_NOT_STARTED = "cannot launch node of type ["  # what roslaunch says
_CRASHES = {
    -code for code in (signal.SIGSEGV, signal.SIGFPE, signal.SIGILL, signal.SIGBUS, signal.SIGABRT)
}
_THROWN = re.compile(r"terminate called after throwing an instance of '(?:[\w:]+<)?(?:\w+::)*(\w+)")


class Outcome(NamedTuple):
    """What a node ran into: the class of an error, and its text; or, without one, its exit code.

    words: what it printed
    """

    kind: str
    text: str
    code: int | None
    words: list[str]


def of_lines(words: list[str], code: int | None) -> Outcome:
    """Return the end of a node whose sources no traceback names."""
    thrown = next(filter(None, map(_THROWN.search, words)), None)
    return Outcome(thrown[1] if thrown else "", "", code, words)


def certainty(case: Case, node: str, end: Outcome, launched: Launched | None = None) -> str:
    """Return how sure it is that the package is to blame.

    launched: what was seen under a launch file, if it ran under one
    """
    launch_file = launched.file if launched else ""
    asks = not launch_file and bool(case.facts.of(node, Kind.ARGUMENTS))
    # None is what says that something was not found, or has not come yet.
    is_given = "NoneType" in end.text or asks and end.kind == "TypeError"
    if end.kind in _MISTAKES and not is_given:
        return SEEN
    if asks or end.kind in _BY_USER or case.facts.of(node, Kind.KEYBOARD):
        return HINT
    if not launch_file and (end.kind or end.code not in _CRASHES):
        return HABIT
    uses_others = end.kind in _OF_OTHERS or bool(case.facts.of(node, Kind.ELSEWHERE))
    texts = [*end.words, *_given(case, node, launch_file)]
    if uses_others or any(map(ELSEWHERE.search, texts)):
        return HABIT
    return HABIT if launched and _lacks(case, node, end, launched) else SEEN


def _given(case: Case, node: str, launch_file: str) -> Iterator[str]:
    """Yield the arguments and the parameters that a launch file gives to a node."""
    for launch in case.launches:
        if launch.file == launch_file:
            yield from (started.arguments for started in launch.nodes if started.type == node)
            yield from map(str, launch.params.values())


def _lacks(case: Case, node: str, end: Outcome, launched: Launched) -> bool:
    """Return whether nobody offers what a node seeks, or another package's node isn't here."""
    absent = [text for text in launched.seen.until_asked() if _NOT_STARTED in text]
    if any(f"[{case.package.name}/" not in text for text in absent):
        return True
    seen = launched.seen.seen
    paths = {path for path, name in launched.nodes.items() if name == node}
    sent, offered = {pub.topic for pub in seen.publications}, {srv.topic for srv in seen.services}
    if end.kind in _OF_FRAMES and not sent & {"/tf", "/tf_static"}:
        return True
    if "NoneType" in end.text:  # a message may not have come
        return any(sub.node in paths and sub.topic not in sent for sub in seen.subscriptions)
    sought = {
        lookup.topic for lookup in seen.lookups if lookup.node in paths and lookup.topic[0] != "~"
    }
    return not sought <= offered
