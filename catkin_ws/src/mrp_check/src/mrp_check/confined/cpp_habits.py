# SPDX-License-Identifier: BSD-3-Clause
"""What a C++ source asks for and offers, and what in it may go wrong: loops, waits, arguments."""

from __future__ import annotations

import functools
import re
from typing import Iterable, Sequence

from mrp_check.confined.cpp_expressions import Cursor, Unit
from mrp_check.confined.places import ELSEWHERE, HOME, Kind

SLEEPS = {"sleep", "usleep", "nanosleep", "sleep_for", "sleep_until"}
_ASKS_TO_END = {"ok", "isShuttingDown", "isStarted", "exit", "_exit", "abort"}
_ASKS_TO_CANCEL = {"isPreemptRequested", "setPreempted", "registerPreemptCallback"}
# The last part of a name -> what a program does that names it.
_NAMES = {
    "program_options": Kind.ARGUMENTS,
    **dict.fromkeys(("serial", "serial_port", "VideoCapture"), Kind.ELSEWHERE),
}
_LEAVES = {"BREAK_STMT", "RETURN_STMT", "CXX_THROW_EXPR", "GOTO_STMT"}


class Habits(Unit):
    def calls(self, cursors: Iterable[Cursor]) -> set[str]:
        """Return the names of all functions that are called there."""
        return {cursor.spelling for cursor in cursors if cursor.kind == self.kinds.CALL_EXPR}

    @functools.cached_property
    def all_calls(self) -> set[str]:
        return self.calls(self.cursors)

    def add_name(self, kind: Kind, call: Cursor, arguments: Sequence[Cursor]) -> None:
        """Note a service, an action or a parameter, by the first text that a call is given."""
        values = (self.value(argument) for argument in arguments[:2])
        name = next((value for value in values if isinstance(value, str)), None)
        if name is None and kind is not Kind.WAITS:
            return
        self.add(call, kind, name)
        if kind is Kind.WAITS and name:
            self.add(call, Kind.ASKS, name)

    def look_at_text(self, literal: Cursor) -> None:
        path = HOME.search(literal.spelling)
        if path:
            self.add(literal, Kind.PATH, path[0])
        if ELSEWHERE.search(literal.spelling):
            self.add(literal, Kind.ELSEWHERE)

    def look_at_name(self, name: Cursor) -> None:
        kind = _NAMES.get(re.split(r"::| ", name.spelling)[-1])
        if kind:
            self.add(name, kind)

    def look_at_subscript(self, part: Cursor) -> None:
        """Note argv[1] and the like, whatever they are called; argv[0] is the program."""
        array, index = part.get_children()
        type_ = self.peel(array).type.get_canonical().spelling
        if type_ in ("char **", "const char **") and self.value(index) != 0:
            self.add(part, Kind.ARGUMENTS)

    def look_at_ignored(self, kind: Kind, call: Cursor, arguments: Sequence[Cursor]) -> None:
        """Note a call whose result nobody looks at; of waitForResult(), the state says it, too."""
        wrapping = (self.kinds.UNEXPOSED_EXPR, self.kinds.PAREN_EXPR)
        parent = next((outer for outer in self.above(call) if outer.kind not in wrapping), None)
        is_statement = parent is not None and parent.kind == self.kinds.COMPOUND_STMT
        is_seen = call.spelling == "waitForResult" and "getState" in self.all_calls
        if is_statement and not is_seen:
            given = [
                argument for argument in arguments if next(argument.get_tokens(), None) is not None
            ]
            least = 1 if call.spelling == "waitForService" else 0
            if len(given) > least:  # without a limit, it only fails on Ctrl-C
                self.add(call, kind, call.spelling)

    def look_at_keyboard(self, cursor: Cursor) -> None:
        """Note std::cin >> and getline(std::cin)."""
        named = (part.spelling for side in cursor.get_children() for part in side.walk_preorder())
        if cursor.spelling in ("operator>>", "getline") and "cin" in named:
            self.add(cursor, Kind.KEYBOARD)

    def look_at_loop(self, loop: Cursor) -> None:
        if not self.is_loop(loop):
            return
        within = [*loop.walk_preorder()]
        called = self.calls(within)
        leaves = bool(_LEAVES & {cursor.kind.name for cursor in within})
        asks = bool(_ASKS_TO_END & called) or any(self.asks(cursor) for cursor in within)
        is_deaf = not leaves and not asks
        endless = "endless" if is_deaf and self.is_endless(loop) else None
        self.add(loop, Kind.LOOP, endless, end=loop.extent.end.line)
        function = self.function(loop)
        if function is not None and {"publishFeedback", "sleep"} & called:
            ends = "setSucceeded" in self.calls(function.walk_preorder())
            if ends and not _ASKS_TO_CANCEL & self.all_calls:
                self.add(loop, Kind.GOAL_LOOP)

    def asks(self, call: Cursor) -> bool:
        """Return whether a function of the package's own is called, which may ask for it."""
        target = call.referenced if call.kind == self.kinds.CALL_EXPR else None
        return target is not None and self.path(target.location.file) is not None

    def is_endless(self, loop: Cursor) -> bool:
        """Return whether the condition of a loop is always true."""
        tokens = [token.spelling for token in loop.get_tokens()]
        if tokens[0] == "for":
            return tokens[:5] == ["for", "(", ";", ";", ")"]
        asked = tokens[1:4] if tokens[0] == "while" else tokens[-3:]
        return asked in (["(", "true", ")"], ["(", "1", ")"])
