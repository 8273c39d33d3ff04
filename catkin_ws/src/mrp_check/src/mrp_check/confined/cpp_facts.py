# SPDX-License-Identifier: BSD-3-Clause
"""Prints, as JSON, what C++ sources say. Runs confined: the sources may be anything.

Usage: cpp_facts.py TASKS, TASKS being JSON: {"folder": FOLDER, "headers": FILE,
"units": [[FILE, ARGUMENT...]...]}; the headers are those of cpp_headers.py. The answer has, for
each file, its places as in facts.Place, or why it could not be read.
"""

import json
import os
import pathlib
import re
import sys

if __name__ == "__main__":
    # In place of this file's own folder, whose modules are none of clang's.
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[2])

from mrp_check.confined.cpp_counters import Counters
from mrp_check.confined.cpp_expressions import MESSAGE
from mrp_check.confined.cpp_text import logged, percent

_LOG = re.compile(r"ROS_(DEBUG|INFO|WARN|ERROR|FATAL)(?:_STREAM)?(?:_\w+)?$")
_LEVELS = {"DEBUG": "debug", "INFO": "info", "WARN": "warn", "ERROR": "error", "FATAL": "fatal"}
_HANDLES = tuple(
    (
        "ros::NodeHandle ros::Publisher ros::Subscriber ros::Timer ros::WallTimer ros::SteadyTimer"
    ).split()
)
_KEPT = ("subscribe", "createTimer", "createWallTimer", "createSteadyTimer", "advertise")
_SPINS = {"spin", "spinOnce", "waitForShutdown", "callAvailable", "callOne", "start"}


def main():
    from clang import cindex

    task = json.loads(sys.argv[1])
    answer = {}
    for file, *arguments in task["units"]:
        try:
            unit = parsed(cindex, file, arguments, task["headers"])
            answer[file] = _Source(cindex, task["folder"], unit).answer()
        except cindex.TranslationUnitLoadError as error:
            answer[file] = {"places": [], "errors": [str(error)]}
    json.dump(answer, sys.stdout)


def parsed(cindex, file, arguments, headers):
    """Return the TranslationUnit of a source; ROS's headers are read only if they must be."""
    try:
        return cindex.Index.create().parse(file, [*arguments, "-include-pch", headers])
    except cindex.TranslationUnitLoadError:
        # There are none, or they do not fit: those of another standard of C++ do not.
        return cindex.Index.create().parse(file, arguments)


class _Source(Counters):
    """Finds the places of one source."""

    def answer(self):
        for cursor in self.cursors:
            look = _LOOKS.get(cursor.kind.name)
            if look:
                look(self, cursor)
        self.look_at_logs()
        errors = [
            [self.path(d.location.file), d.location.line, d.spelling]
            for d in self.unit.diagnostics
            if d.severity >= d.Error
        ]
        return {"places": self.places, "errors": errors, "named": sorted(self.named)}

    def look_at_loop(self, cursor):
        if self.is_loop(cursor):
            self.add(cursor, "loop")

    def look_at_return(self, cursor):
        function = self.function(cursor)
        if function is not None and function.spelling == "main":
            code = self.value(next(cursor.get_children(), None))
            self.add(cursor, "exit", "return", code=code)

    def look_at_function(self, cursor):
        if not cursor.is_definition():
            return
        used = cursor.spelling == "main" or "operator" in cursor.spelling
        virtual = cursor.kind == self.kinds.CXX_METHOD and cursor.is_virtual_method()
        usr = None if used or virtual else cursor.canonical.get_usr()
        self.add(cursor, "function", cursor.spelling, end=cursor.extent.end.line, usr=usr)

    def look_at_call(self, call):
        arguments, scope = list(call.get_arguments()), self.scope(call)
        for scopes, names, look in _CALLS:
            if call.spelling in names and scope in (scopes or (scope,)):
                look(self, call, arguments)
        if call.spelling in _KEPT and scope == "NodeHandle":
            self.look_at_kept(call)

    def scope(self, call):
        """Return the name of the class or namespace of what is called."""
        parent = call.referenced.semantic_parent if call.referenced is not None else None
        return parent.spelling if parent else ""

    def add_spin(self, call, arguments):
        scope = self.scope(call)
        if scope in ("ros", "CallbackQueue") or "Spinner" in scope:
            self.add(call, "spin", call.spelling)

    def add_init(self, call, arguments):
        options = arguments[3].get_tokens() if len(arguments) > 3 else ()
        anonymous = any("AnonymousName" in token.spelling for token in options)
        offset = call.extent.start.offset
        name = self.optional(arguments, 2)
        self.add(call, "init", name, anonymous=anonymous or None, offset=offset)

    def add_publisher(self, call, arguments):
        self.add_topic(call, "publisher", arguments, latch=self.optional(arguments, 2))

    def add_subscriber(self, call, arguments):
        self.add_topic(call, "subscriber", arguments)

    def add_timer(self, call, arguments):
        period = self.optional(arguments, 0)
        period = period if isinstance(period, (int, float)) else None
        self.add(call, "timer", period=period, oneshot=self.optional(arguments, 3))

    def add_rate(self, call, arguments):
        target, rate = call.referenced, self.optional(arguments, 0)
        is_made = target is not None and target.kind == self.kinds.CONSTRUCTOR
        if is_made and isinstance(rate, (int, float)) and rate:
            self.add(call, "timer", period=1 / rate)

    def add_publish(self, call, arguments):
        if self.scope(call) == "Publisher" or "Publisher" in self.type_of(self.base(call)):
            self.add(call, "publish")

    def add_exit(self, call, arguments):
        self.add(call, "exit", call.spelling, code=self.optional(arguments, 0))

    def add_signal(self, call, arguments):
        self.add(call, "signal", call.spelling)

    def add_sleep(self, call, arguments):
        self.add(call, "sleep", call.spelling)

    def add_print(self, call, arguments):
        text = self.optional(arguments, 0)
        self.add(call, "print", percent(text) if isinstance(text, str) else None)

    def optional(self, arguments, index):
        return self.value(arguments[index]) if index < len(arguments) else None

    def add_topic(self, call, kind, arguments, **values):
        topic = self.value(arguments[0]) if arguments else None
        if isinstance(topic, str):
            prefix = self.namespace(self.base(call))
            if prefix and not topic.startswith(("/", "~")):
                topic = f"{prefix}/{topic}" if prefix != "~" else "~" + topic
        queue = self.optional(arguments, 1)
        self.add(
            call,
            kind,
            topic,
            type=self.message(call, arguments, kind),
            queue=queue if isinstance(queue, int) else None,
            **values,
        )

    def namespace(self, handle):
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
            text = next((one for one in texts if isinstance(one, str)), None)
        return text or None

    def message(self, call, arguments, kind):
        member = next(call.get_children(), None)
        for child in member.get_children() if member is not None else ():
            if child.kind == self.kinds.TYPE_REF:
                text = (
                    child.type.get_canonical().spelling
                    or child.referenced.type.get_canonical().spelling
                )
                found = MESSAGE.search(text)
                if found:
                    return "/".join(found.groups())
        for argument in arguments[2:]:
            for cursor in (argument, self.peel(argument)):
                found = MESSAGE.search(cursor.type.get_canonical().spelling)
                if found:
                    return "/".join(found.groups())
        if kind == "subscriber" and call.referenced is not None:
            found = MESSAGE.search(call.referenced.type.get_canonical().spelling)
            return "/".join(found.groups()) if found else None
        return None

    def look_at_kept(self, call):
        """Note what is made and not kept: it ends at once, or with its function."""
        kinds = self.kinds
        # The second is as in (void)nh.subscribe(...).
        wrapping = (kinds.UNEXPOSED_EXPR, kinds.CSTYLE_CAST_EXPR)
        around = [one for one in self.above(call) if one.kind not in wrapping][:1]
        for parent in around:
            if parent.kind == kinds.COMPOUND_STMT:
                self.add(call, "discarded", call.spelling)
            variable = parent
            if parent.kind == kinds.CALL_EXPR:
                variable = self.parents.get(parent.hash)
            if variable is not None and variable.kind == kinds.VAR_DECL:
                self.look_at_local(call, variable)

    def look_at_local(self, call, variable):
        """Note what is kept in a variable that ends before the node does."""
        function = self.function(variable)
        if function is None or function.spelling == "main":
            return
        is_static = any(t.spelling == "static" for t in variable.get_tokens())
        if not (is_static or self.is_handed_on(variable) or self.waits(function)):
            names = {"name": variable.spelling, "function": function.spelling}
            self.add(call, "local", call.spelling, **names)

    def is_handed_on(self, variable):
        """Return whether a variable is used otherwise than to publish, and so perhaps kept."""
        key, kinds = variable.canonical.hash, self.kinds
        published = sum(
            cursor.kind == kinds.CALL_EXPR
            and cursor.spelling == "publish"
            and (self.base(cursor) or variable).referenced == variable
            for cursor in self.cursors
        )
        return self.uses.get(key, 0) > published

    def waits(self, function):
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

    def is_own(self, target):
        """Return whether a called function is the package's own: it may wait in turn."""
        return (
            target is not None
            and target.location.file is not None
            and self.path(target.location.file)
            and target.kind != self.kinds.CONSTRUCTOR
        )

    def look_at_variable(self, variable):
        text = self.type_of(variable)
        kinds = self.kinds
        function = self.function(variable)
        is_global = (
            variable.kind == kinds.VAR_DECL
            and function is None
            and (
                variable.semantic_parent is None
                or variable.semantic_parent.kind in (kinds.TRANSLATION_UNIT, kinds.NAMESPACE)
            )
        )
        if text in _HANDLES:
            kind = "global" if is_global else "handle"
            self.add(
                variable,
                kind,
                text,
                name=variable.spelling,
                offset=variable.extent.start.offset,
                function=function.spelling if function is not None else None,
            )
        elif is_global and (inside := self.handles_in(variable.type.get_declaration())):
            self.add(variable, "global", text, name=variable.spelling, holds=inside)
        elif is_global and (holds := self.owned_handles(variable)):
            self.add(variable, "owner", text, name=variable.spelling, holds=holds)
        elif text.startswith("std::") is False and variable.kind == kinds.VAR_DECL:
            inside = self.handles_in(variable.type.get_canonical().get_declaration())
            if inside and function is not None:
                self.add(
                    variable,
                    "handle",
                    text,
                    name=variable.spelling,
                    holds=inside,
                    offset=variable.extent.start.offset,
                    function=function.spelling,
                )

    def owned_handles(self, variable):
        """Return the types of ROS handles in what a smart pointer, or the like, owns."""
        kind = variable.type.get_canonical()
        owned = [
            kind.get_template_argument_type(n) for n in range(kind.get_num_template_arguments())
        ]
        if not owned or owned[0].kind.name == "INVALID":
            return []
        text = owned[0].get_canonical().spelling
        return [text] if text in _HANDLES else self.handles_in(owned[0].get_declaration())

    def handles_in(self, declaration):
        """Return the types of ROS handles among a class's own members."""
        if declaration is None or not self.own_file(declaration):
            return []
        fields = [c for c in declaration.get_children() if c.kind == self.kinds.FIELD_DECL]
        return sorted({self.type_of(field) for field in fields} & set(_HANDLES))

    def look_at_logs(self):
        """Look at each ROS_INFO... that is compiled: then something stands at its place."""
        at = {}
        for cursor in self.cursors:
            if self.own_file(cursor):
                place = cursor.location
                at.setdefault((place.file.name, place.offset), cursor)
        for file in {name for name, _ in at}:
            extent = self.unit.get_extent(file, (0, os.path.getsize(file)))
            tokens = list(self.unit.get_tokens(extent=extent))
            words = [token.spelling for token in tokens]
            for number, word in enumerate(words):
                found = _LOG.match(word)
                cursor = found and at.get((file, tokens[number].location.offset))
                if cursor:
                    level = _LEVELS[found.group(1)]
                    self.add(cursor, "log", logged(word, words[number:]), level=level)


# kind of a cursor -> what looks at it
_LOOKS = {
    "CALL_EXPR": _Source.look_at_call,
    **dict.fromkeys(("VAR_DECL", "FIELD_DECL"), _Source.look_at_variable),
    **dict.fromkeys(
        ("COMPOUND_ASSIGNMENT_OPERATOR", "BINARY_OPERATOR", "UNARY_OPERATOR"),
        _Source.look_at_operator,
    ),
    **dict.fromkeys(("IF_STMT", "CONDITIONAL_OPERATOR"), _Source.look_at_reset),
    **dict.fromkeys(("WHILE_STMT", "DO_STMT", "FOR_STMT"), _Source.look_at_loop),
    "RETURN_STMT": _Source.look_at_return,
    **dict.fromkeys(("FUNCTION_DECL", "CXX_METHOD"), _Source.look_at_function),
}
# (scopes or None for any, names) of a call, and what looks at it
_HANDLE = ("NodeHandle",)
_CALLS = (
    (("ros",), ("init",), _Source.add_init),
    (_HANDLE, ("advertise",), _Source.add_publisher),
    (_HANDLE, ("subscribe",), _Source.add_subscriber),
    (_HANDLE, ("createTimer", "createWallTimer", "createSteadyTimer"), _Source.add_timer),
    (None, ("Rate", "WallRate"), _Source.add_rate),
    (None, ("publish",), _Source.add_publish),
    (None, _SPINS, _Source.add_spin),
    (
        None,
        ("exit", "_exit", "quick_exit", "abort", "shutdown", "requestShutdown"),
        _Source.add_exit,
    ),
    (None, ("signal", "sigaction"), _Source.add_signal),
    (None, ("sleep", "usleep", "sleep_for"), _Source.add_sleep),
    (("", "std"), ("printf", "puts"), _Source.add_print),
)


if __name__ == "__main__":
    main()
