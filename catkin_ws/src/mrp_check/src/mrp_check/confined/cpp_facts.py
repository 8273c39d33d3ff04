# SPDX-License-Identifier: BSD-3-Clause
"""Prints what a C++ source says, as a places.Said. Runs confined: the source may be anything.

Usage: cpp_facts.py FOLDER HEADERS SOURCE [ARGUMENT...]    (the package's folder, the file of
cpp_headers.py, and what the compiler is called with)
"""

from __future__ import annotations

import ctypes
import os
import pathlib
import re
import sys
import types
from typing import Sequence

if __name__ == "__main__":
    # In place of this file's own folder, whose modules are none of clang's.
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[2])

from mrp_check.confined import crossing
from mrp_check.confined.cpp_counters import Counters
from mrp_check.confined.cpp_expressions import Cursor
from mrp_check.confined.cpp_habits import SLEEPS, Habits
from mrp_check.confined.places import Kind, Plain, Said

_LOG = re.compile(r"ROS_(?:DEBUG|INFO|WARN|ERROR|FATAL)(?:_STREAM)?(?:_\w+)?$")
_HANDLES = tuple(
    (
        "ros::NodeHandle ros::Publisher ros::Subscriber ros::Timer ros::WallTimer ros::SteadyTimer"
    ).split()
)
_TIMERS = ("createTimer", "createWallTimer", "createSteadyTimer")
_KEPT = ("subscribe", "advertise", *_TIMERS)
_EXITS = ("exit", "_exit", "quick_exit", "abort", "shutdown", "requestShutdown")
_SPINS = {"spin", "spinOnce", "waitForShutdown", "callAvailable", "callOne", "start"}

Arguments = Sequence[Cursor]  # of a call


def main() -> None:
    from clang import cindex

    # A source may be in any encoding, and clang's names are what it has read.
    cindex.c_interop_string.value = property(_text)
    folder, headers, file, *arguments = sys.argv[1:]
    try:
        result = _Source(cindex, folder, parsed(cindex, file, arguments, headers)).said()
    except cindex.TranslationUnitLoadError as error:
        result = Said(errors=[str(error)])
    sys.stdout.write(crossing.to_json(result))


def _text(name: ctypes.c_char_p) -> str | None:
    data = ctypes.cast(name, ctypes.c_char_p).value
    return None if data is None else data.decode(errors="replace")


def parsed(cindex: types.ModuleType, file: str, arguments: list[str], headers: str) -> Cursor:
    """Return the TranslationUnit of a source; ROS's headers are read only if they must be."""
    try:
        return cindex.Index.create().parse(file, [*arguments, "-include-pch", headers])
    except cindex.TranslationUnitLoadError:
        # There are none, or they do not fit: those of another standard of C++ do not.
        return cindex.Index.create().parse(file, arguments)


class _Source(Counters, Habits):
    """Finds the places of one source."""

    def said(self) -> Said:
        for cursor in self.cursors:
            look = _LOOKS.get(cursor.kind.name)
            if look:
                look(self, cursor)
        self.look_at_logs()
        errors = [d.spelling for d in self.unit.diagnostics if d.severity >= d.Error]
        return Said(self.places, errors, sorted(self.named))

    def look_at_return(self, cursor: Cursor) -> None:
        function = self.function(cursor)
        if function is not None and function.spelling == "main":
            self.add(cursor, Kind.EXIT, "return", value=self.code(cursor, [*cursor.get_children()]))

    def look_at_function(self, cursor: Cursor) -> None:
        if not cursor.is_definition():
            return
        used = cursor.spelling == "main" or "operator" in cursor.spelling
        virtual = cursor.kind == self.kinds.CXX_METHOD and cursor.is_virtual_method()
        usr = None if used or virtual else cursor.canonical.get_usr()
        self.add(cursor, Kind.FUNCTION, cursor.spelling, end=cursor.extent.end.line, usr=usr)

    def look_at_call(self, call: Cursor) -> None:
        arguments, scope = list(call.get_arguments()), self.scope(call)
        for scopes, names, kind, look in _CALLS:
            if call.spelling in names and scope in (scopes or (scope,)):
                look(self, kind, call, arguments)
        if call.spelling in _KEPT and scope == "NodeHandle":
            self.look_at_kept(call)
        self.look_at_keyboard(call)

    def scope(self, call: Cursor) -> str:
        """Return the name of the class or namespace of what is called."""
        parent = call.referenced.semantic_parent if call.referenced is not None else None
        return parent.spelling if parent else ""

    def add_call(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        self.add(call, kind, call.spelling)

    def add_exit(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        self.add(call, kind, call.spelling, value=self.code(call, arguments))

    def code(self, cursor: Cursor, arguments: Arguments) -> int:
        """Return the code that exit() or return is given; 0 if that is not plain."""
        code = self.optional(arguments, 0)
        is_macro = any(token.spelling == "EXIT_FAILURE" for token in cursor.get_tokens())
        return code if isinstance(code, int) else int(is_macro)

    def add_spin(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        scope = self.scope(call)
        if scope in ("ros", "CallbackQueue") or "Spinner" in scope:
            self.add(call, kind, call.spelling)

    def add_init(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        options = arguments[3].get_tokens() if len(arguments) > 3 else ()
        anonymous = any("AnonymousName" in token.spelling for token in options)
        self.add(call, kind, self.optional(arguments, 2), anonymous=anonymous or None)

    def add_timer(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        period = self.optional(arguments, 0)
        period = period if isinstance(period, (int, float)) else None
        self.add(call, kind, period=period, oneshot=self.optional(arguments, 3))

    def add_rate(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        target, rate = call.referenced, self.optional(arguments, 0)
        is_made = target is not None and target.kind == self.kinds.CONSTRUCTOR
        if is_made and isinstance(rate, (int, float)) and rate:
            self.add(call, kind, period=1 / rate)

    def add_publish(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        if self.scope(call) == "Publisher" or "Publisher" in self.type_of(self.base(call)):
            self.add(call, kind)

    def optional(self, arguments: Arguments, index: int) -> Plain:
        return self.value(arguments[index]) if index < len(arguments) else None

    def add_topic(self, kind: Kind, call: Cursor, arguments: Arguments) -> None:
        topic = self.value(arguments[0]) if arguments else None
        if isinstance(topic, str):
            prefix = self.namespace(self.base(call))
            if prefix and not topic.startswith(("/", "~")):
                topic = f"{prefix}/{topic}" if prefix != "~" else "~" + topic
        queue = self.optional(arguments, 1)
        given = next(arguments[2].get_tokens(), None) if len(arguments) > 2 else None
        latch = kind is Kind.PUBLISHER and given is not None and given.spelling != "false"
        self.add(call, kind, topic, queue=queue if isinstance(queue, int) else None, latch=latch)

    def namespace(self, handle: Cursor | None) -> str | None:
        """Return what a NodeHandle was made with, such as "~", or None if it has none."""
        handle = self.peel(handle) if handle is not None else None
        target = handle.referenced if handle is not None else None
        made = self.initial(target) if target is not None else None
        if made is None:
            return None
        text = self.value(made)
        if not isinstance(text, str):
            texts = (
                [self.value(child) for child in made.get_arguments()]
                if made.kind == self.kinds.CALL_EXPR
                else []
            )
            text = next((value for value in texts if isinstance(value, str)), None)
        return text or None

    def look_at_kept(self, call: Cursor) -> None:
        """Note what is made and not kept: it ends at once, or with its function."""
        kinds = self.kinds
        # The second is as in (void)nh.subscribe(...).
        wrapping = (kinds.UNEXPOSED_EXPR, kinds.CSTYLE_CAST_EXPR)
        around = [outer for outer in self.above(call) if outer.kind not in wrapping][:1]
        for parent in around:
            if parent.kind == kinds.COMPOUND_STMT:
                self.add(call, Kind.DISCARDED, call.spelling)
            variable = parent
            if parent.kind == kinds.CALL_EXPR:
                variable = self.parents.get(parent.hash)
            if variable is not None and variable.kind == kinds.VAR_DECL:
                self.look_at_local(call, variable)

    def look_at_local(self, call: Cursor, variable: Cursor) -> None:
        """Note what is kept in a variable that ends before the node does."""
        function = self.function(variable)
        if function is None or function.spelling == "main":
            return
        is_static = any(t.spelling == "static" for t in variable.get_tokens())
        if not (is_static or self.is_handed_on(variable) or self.waits(function)):
            name, inside = variable.spelling, function.spelling
            self.add(call, Kind.LOCAL, call.spelling, name=name, function=inside)

    def is_handed_on(self, variable: Cursor) -> bool:
        """Return whether a variable is used otherwise than to publish, and so perhaps kept."""
        key, kinds = variable.canonical.hash, self.kinds
        published = sum(
            cursor.kind == kinds.CALL_EXPR
            and cursor.spelling == "publish"
            and self.names(self.base(cursor) or variable, variable)
            for cursor in self.cursors
        )
        return self.uses.get(key, 0) > int(published)

    def waits(self, function: Cursor) -> bool:
        """Return whether a function itself spins or loops, and so keeps its variables."""
        kinds = self.kinds
        for cursor in function.walk_preorder():
            if self.is_loop(cursor):
                return True
            if cursor.kind == kinds.CALL_EXPR and (
                cursor.spelling in _SPINS or self.is_own(cursor.referenced)
            ):
                return True
        return False

    def is_own(self, target: Cursor | None) -> bool:
        """Return whether a called function is the package's own: it may wait in turn."""
        if target is None or target.kind == self.kinds.CONSTRUCTOR:
            return False
        return self.path(target.location.file) is not None

    def look_at_variable(self, variable: Cursor) -> None:
        text, kinds, function = self.type_of(variable), self.kinds, self.function(variable)
        is_variable, above = variable.kind == kinds.VAR_DECL, variable.semantic_parent
        at_file_scope = above is None or above.kind in (kinds.TRANSLATION_UNIT, kinds.NAMESPACE)
        is_global = is_variable and function is None and at_file_scope
        name = variable.spelling
        if text in _HANDLES:
            kind = Kind.GLOBAL if is_global else Kind.HANDLE
            self.add(variable, kind, text, name=name)
        elif is_global:
            held = self.handles_in(variable.type.get_declaration())
            owned = [] if held else self.owned_handles(variable)
            if held or owned:
                kind = Kind.GLOBAL if held else Kind.OWNER
                self.add(variable, kind, text, holds=held or owned, name=name)
        elif is_variable and function is not None and not text.startswith("std::"):
            held = self.handles_in(variable.type.get_canonical().get_declaration())
            if held:
                self.add(variable, Kind.HANDLE, text, holds=held, name=name)

    def owned_handles(self, variable: Cursor) -> list[str]:
        """Return the types of ROS handles in what a smart pointer, or the like, owns."""
        kind = variable.type.get_canonical()
        owned = [
            kind.get_template_argument_type(n) for n in range(kind.get_num_template_arguments())
        ]
        if not owned or owned[0].kind.name == "INVALID":
            return []
        text = owned[0].get_canonical().spelling
        return [text] if text in _HANDLES else self.handles_in(owned[0].get_declaration())

    def handles_in(self, declaration: Cursor | None) -> list[str]:
        """Return the types of ROS handles among a class's own members."""
        if declaration is None or not self.own_file(declaration):
            return []
        fields = [c for c in declaration.get_children() if c.kind == self.kinds.FIELD_DECL]
        return sorted({self.type_of(field) for field in fields} & set(_HANDLES))

    def look_at_logs(self) -> None:
        """Look at each ROS_INFO... that is compiled: then something stands at its place."""
        at: dict[tuple[str, int], Cursor] = {}
        for cursor in self.cursors:
            if self.own_file(cursor):
                place = cursor.location
                at.setdefault((place.file.name, place.offset), cursor)
        for file in {name for name, _ in at}:
            extent = self.unit.get_extent(file, (0, os.path.getsize(file)))
            for token in self.unit.get_tokens(extent=extent):
                found = _LOG.match(token.spelling)
                cursor = found and at.get((file, token.location.offset))
                if cursor:
                    self.add(cursor, Kind.LOG)


# kind of a cursor -> what looks at it
_LOOKS = {
    "CALL_EXPR": _Source.look_at_call,
    **dict.fromkeys(("VAR_DECL", "FIELD_DECL"), _Source.look_at_variable),
    **dict.fromkeys(
        ("COMPOUND_ASSIGNMENT_OPERATOR", "BINARY_OPERATOR", "UNARY_OPERATOR"),
        _Source.look_at_operator,
    ),
    **dict.fromkeys(("WHILE_STMT", "DO_STMT", "FOR_STMT"), _Source.look_at_loop),
    "RETURN_STMT": _Source.look_at_return,
    "STRING_LITERAL": _Source.look_at_text,
    "ARRAY_SUBSCRIPT_EXPR": _Source.look_at_subscript,
    **dict.fromkeys(("NAMESPACE_REF", "TYPE_REF"), _Source.look_at_name),
    **dict.fromkeys(("FUNCTION_DECL", "CXX_METHOD"), _Source.look_at_function),
}
# (scopes or None for any, names) of a call, what it is, and what looks at it
_HANDLE, _PARAM = ("NodeHandle",), ("NodeHandle", "param")
_GOAL_ENDS = ("setSucceeded", "setAborted", "setPreempted", "setCanceled")
_FAIL = ("waitForServer", "waitForResult", "waitForExistence", "waitForService")
_CALLS = (
    (("ros",), ("init",), Kind.INIT, _Source.add_init),
    (_HANDLE, ("advertise",), Kind.PUBLISHER, _Source.add_topic),
    (_HANDLE, ("subscribe",), Kind.SUBSCRIBER, _Source.add_topic),
    (_HANDLE, _TIMERS, Kind.TIMER, _Source.add_timer),
    (None, ("Rate", "WallRate"), Kind.TIMER, _Source.add_rate),
    (None, ("publish",), Kind.PUBLISH, _Source.add_publish),
    (None, _SPINS, Kind.SPIN, _Source.add_spin),
    (None, _EXITS, Kind.EXIT, _Source.add_exit),
    (None, ("signal", "sigaction"), Kind.SIGNAL, _Source.add_call),
    (None, tuple(SLEEPS), Kind.SLEEP, _Source.add_call),
    (_HANDLE, ("serviceClient",), Kind.ASKS, _Source.add_name),
    (_HANDLE, ("advertiseService",), Kind.OFFERS, _Source.add_name),
    (_HANDLE, ("getParam",), Kind.READS, _Source.add_name),
    (_PARAM, ("param", "getParamCached", "hasParam", "searchParam"), Kind.READS, _Source.add_name),
    (("param",), ("get", "has", "search", "getCached"), Kind.READS, _Source.add_name),
    (("service",), ("waitForService", "exists"), Kind.WAITS, _Source.add_name),
    (None, ("waitForExistence", "waitForServer"), Kind.WAITS, _Source.add_name),
    (None, ("SimpleActionClient",), Kind.COMMANDS, _Source.add_name),
    (None, ("SimpleActionServer",), Kind.SERVES, _Source.add_name),
    (None, _GOAL_ENDS, Kind.ENDS, _Source.add_call),
    (("", "std"), ("fork", "vfork", "popen", "system"), Kind.STARTS, _Source.add_call),
    (("",), ("kill", "killpg"), Kind.KILLS, _Source.add_call),
    (None, ("getopt", "getopt_long", "removeROSArgs"), Kind.ARGUMENTS, _Source.add_call),
    (None, _FAIL, Kind.IGNORED, _Source.look_at_ignored),
    (("ServiceClient",), ("call",), Kind.IGNORED, _Source.look_at_ignored),
    (("", "std"), ("printf", "puts"), Kind.PRINT, _Source.add_call),
)


if __name__ == "__main__":
    main()
