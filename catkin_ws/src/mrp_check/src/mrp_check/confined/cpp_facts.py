# SPDX-License-Identifier: BSD-3-Clause
"""Prints, as JSON, what C++ sources say. Runs confined: the sources may be anything.

Usage: cpp_facts.py TASKS, TASKS being JSON: {"folder": FOLDER, "headers": FILE,
"units": [[FILE, ARGUMENT...]...]}; the headers are those of cpp_headers.py. The answer has, for
each file, its places as in facts.Place, or why it could not be read.
"""

import json
import os
import re
import sys

GAP = "{}"
_LOG = re.compile(r"ROS_(DEBUG|INFO|WARN|ERROR|FATAL)(?:_STREAM)?(?:_\w+)?$")
_LEVELS = {"DEBUG": "debug", "INFO": "info", "WARN": "warn", "ERROR": "error", "FATAL": "fatal"}
_MESSAGE = re.compile(r"\b(\w+)::(\w+?)_<")
_HANDLES = tuple(
    (
        "ros::NodeHandle ros::Publisher ros::Subscriber ros::Timer ros::WallTimer ros::SteadyTimer"
    ).split()
)
_KEPT = ("subscribe", "createTimer", "createWallTimer", "createSteadyTimer", "advertise")
_SPINS = {"spin", "spinOnce", "waitForShutdown", "callAvailable", "callOne", "start"}


def main():
    del sys.path[0]  # this file's folder, whose modules are none of clang's
    from clang import cindex

    task = json.loads(sys.argv[1])
    answer = {}
    for file, *arguments in task["units"]:
        try:
            unit = parsed(cindex, file, arguments, task["headers"])
            answer[file] = _Unit(cindex, task["folder"], unit).answer()
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


class _Unit:
    def __init__(self, cindex, folder, unit):
        self.kinds = cindex.CursorKind
        self.folder = folder
        self.places = []
        self.unit = unit
        self.parents = {}
        self.uses = {}  # variable -> how often it is named
        self.named = set()  # functions that are named
        self.cursors = []
        for cursor in self.unit.cursor.get_children():
            if self.own_file(cursor):
                self.collect(cursor, None)

    def answer(self):
        for cursor in self.cursors:
            self.look_at(cursor)
        self.look_at_logs()
        errors = [
            [self.path(d.location.file), d.location.line, d.spelling]
            for d in self.unit.diagnostics
            if d.severity >= d.Error
        ]
        return {"places": self.places, "errors": errors, "named": sorted(self.named)}

    def path(self, file):
        path = os.path.normpath(file.name) if file else ""
        return os.path.relpath(path, self.folder) if path.startswith(self.folder + "/") else None

    def own_file(self, cursor):
        return cursor.location.file is not None and self.path(cursor.location.file)

    def collect(self, cursor, parent, depth=0):
        self.cursors.append(cursor)
        self.parents[cursor.hash] = parent
        if cursor.kind in (self.kinds.DECL_REF_EXPR, self.kinds.MEMBER_REF_EXPR):
            target = cursor.referenced
            if target is not None:
                key = target.canonical.hash
                self.uses[key] = self.uses.get(key, 0) + 1
                self.named.add(target.canonical.get_usr())
        if depth < 150:
            for child in cursor.get_children():
                self.collect(child, cursor, depth + 1)

    def above(self, cursor):
        parent = self.parents.get(cursor.hash)
        while parent is not None:
            yield parent
            parent = self.parents.get(parent.hash)

    def add(self, cursor, kind, text=None, line=None, **values):
        file = self.own_file(cursor)
        if not file:
            return
        values = {key: value for key, value in values.items() if value is not None}
        text = text if isinstance(text, str) and text.replace(GAP, "") else None
        self.places.append(
            {
                "file": file,
                "line": line or cursor.location.line,
                "kind": kind,
                "text": text,
                "values": values,
            }
        )

    # What an expression says plainly.

    def peel(self, cursor):
        """Return the expression without casts, brackets and constructors of one argument."""
        kinds = self.kinds
        while True:
            children = [
                c
                for c in cursor.get_children()
                if c.kind not in (kinds.TYPE_REF, kinds.NAMESPACE_REF, kinds.TEMPLATE_REF)
            ]
            wrapping = cursor.kind in (
                kinds.UNEXPOSED_EXPR,
                kinds.PAREN_EXPR,
                kinds.CSTYLE_CAST_EXPR,
                kinds.CXX_STATIC_CAST_EXPR,
                kinds.CXX_FUNCTIONAL_CAST_EXPR,
                kinds.INIT_LIST_EXPR,
            )
            constructing = cursor.kind == kinds.CALL_EXPR and (
                cursor.referenced is not None
                and cursor.referenced.kind == kinds.CONSTRUCTOR
                or cursor.spelling
                in (
                    "basic_string",
                    "Duration",
                    "WallDuration",
                    "Rate",
                    "WallRate",
                    "SteadyDuration",
                    "move",
                )
            )
            if constructing:
                children = [
                    c for c in children if c.location.line or c.kind != kinds.UNEXPOSED_EXPR
                ]
                if cursor.spelling == "basic_string":
                    children = children[:1]
                if cursor.spelling == "move":
                    children = children[1:]
            if not (wrapping or constructing) or len(children) != 1:
                return cursor
            cursor = children[0]

    def value(self, cursor, depth=0):
        """Return the plain number, truth value or text of an expression, or None."""
        if cursor is None or depth > 12:
            return None
        kinds = self.kinds
        cursor = self.peel(cursor)
        if cursor.kind == kinds.STRING_LITERAL:
            try:
                return json.loads(cursor.spelling, strict=False)
            except ValueError:
                return None
        if cursor.kind in (kinds.INTEGER_LITERAL, kinds.FLOATING_LITERAL):
            token = next((t.spelling for t in cursor.get_tokens()), "").replace("'", "")
            return number(token)
        if cursor.kind == kinds.CXX_BOOL_LITERAL_EXPR:
            return next((t.spelling for t in cursor.get_tokens()), "") == "true"
        if cursor.kind in (kinds.DECL_REF_EXPR, kinds.MEMBER_REF_EXPR):
            target = cursor.referenced
            if target is not None and target.kind in (kinds.VAR_DECL, kinds.FIELD_DECL):
                if target.hash in self.changed:
                    return None
                return self.value(self.initial(target), depth + 1)
            return None
        children = list(cursor.get_children())
        if cursor.kind == kinds.UNARY_OPERATOR and children:
            inside = self.value(children[0], depth + 1)
            sign = next((t.spelling for t in cursor.get_tokens()), "")
            return -inside if sign == "-" and isinstance(inside, (int, float)) else None
        if cursor.kind == kinds.BINARY_OPERATOR and len(children) == 2:
            return arithmetic(
                self.operator(cursor, children),
                self.value(children[0], depth + 1),
                self.value(children[1], depth + 1),
            )
        if cursor.kind == kinds.CALL_EXPR:
            if cursor.spelling == "operator+" and len(children) == 3:
                # the left, the operator, the right
                parts = [self.value(children[0], depth + 1), self.value(children[2], depth + 1)]
                if any(isinstance(part, str) for part in parts):
                    return "".join(part if isinstance(part, str) else GAP for part in parts)
            if cursor.spelling in ("resolveName", "resolve") and len(children) > 1:
                return self.value(children[1], depth + 1)
        return None

    @property
    def changed(self):
        """Variables that are given a value in more places than their declaration."""
        if not hasattr(self, "_changed"):
            self._changed = set()
            kinds = self.kinds
            for cursor in self.cursors:
                children = list(cursor.get_children())
                if not children:
                    continue
                assigns = cursor.kind == kinds.COMPOUND_ASSIGNMENT_OPERATOR
                if cursor.kind == kinds.BINARY_OPERATOR and len(children) == 2:
                    assigns = self.operator(cursor, children) == "="
                if cursor.kind == kinds.UNARY_OPERATOR:
                    tokens = [t.spelling for t in cursor.get_tokens()]
                    assigns = "++" in tokens or "--" in tokens or "&" in tokens[:1]
                target = self.peel(children[0]).referenced if assigns else None
                if target is not None:
                    self._changed.add(target.hash)
        return self._changed

    def operator(self, cursor, children):
        end = children[0].extent.end.offset
        for token in cursor.get_tokens():
            if token.extent.start.offset >= end:
                return token.spelling
        return ""

    def initial(self, declaration):
        """Return the expression that a variable or a field begins with, or None."""
        kinds = self.kinds
        given = [
            c
            for c in declaration.get_children()
            if c.kind.is_expression() and c.kind not in (kinds.TYPE_REF, kinds.NAMESPACE_REF)
        ]
        if given:
            return given[-1]
        for constructor in self.cursors:
            if constructor.kind != kinds.CONSTRUCTOR:
                continue
            member = None
            for child in constructor.get_children():
                if child.kind == kinds.MEMBER_REF:
                    member = child.referenced
                elif member is not None and member == declaration and child.kind.is_expression():
                    return child
        return None

    def arguments(self, call):
        return list(call.get_arguments())

    # Places

    def look_at(self, cursor):
        kinds = self.kinds
        if cursor.kind == kinds.CALL_EXPR:
            self.look_at_call(cursor)
        elif cursor.kind in (kinds.VAR_DECL, kinds.FIELD_DECL):
            self.look_at_variable(cursor)
        elif cursor.kind in (
            kinds.COMPOUND_ASSIGNMENT_OPERATOR,
            kinds.BINARY_OPERATOR,
            kinds.UNARY_OPERATOR,
        ):
            self.look_at_operator(cursor)
        elif cursor.kind in (kinds.IF_STMT, kinds.CONDITIONAL_OPERATOR):
            self.look_at_reset(cursor)
        elif self.is_loop(cursor):
            self.add(cursor, "loop")
        elif cursor.kind == kinds.RETURN_STMT:
            function = self.function(cursor)
            if function is not None and function.spelling == "main":
                code = self.value(next(cursor.get_children(), None))
                self.add(cursor, "exit", "return", code=code)
        elif cursor.kind in (kinds.FUNCTION_DECL, kinds.CXX_METHOD) and cursor.is_definition():
            used = cursor.spelling == "main" or "operator" in cursor.spelling
            virtual = cursor.kind == kinds.CXX_METHOD and cursor.is_virtual_method()
            self.add(
                cursor,
                "function",
                cursor.spelling,
                end=cursor.extent.end.line,
                usr=None if used or virtual else cursor.canonical.get_usr(),
            )

    def is_loop(self, cursor):
        """Return whether it is a loop of the source's own: those of ROS_INFO are none."""
        kinds = self.kinds
        if cursor.kind not in (kinds.WHILE_STMT, kinds.DO_STMT, kinds.FOR_STMT):
            return False
        first = next((token.spelling for token in cursor.get_tokens()), "")
        return first in ("while", "do", "for")

    def function(self, cursor):
        kinds = self.kinds
        for parent in self.above(cursor):
            if parent.kind in (
                kinds.FUNCTION_DECL,
                kinds.CXX_METHOD,
                kinds.CONSTRUCTOR,
                kinds.LAMBDA_EXPR,
                kinds.DESTRUCTOR,
                kinds.FUNCTION_TEMPLATE,
            ):
                return parent
        return None

    def base(self, call):
        """Return the expression before the dot of a call, or None."""
        member = next(call.get_children(), None)
        if member is None or member.kind != self.kinds.MEMBER_REF_EXPR:
            return None
        return next(member.get_children(), None)

    def type_of(self, cursor):
        if cursor is None:
            return ""
        text = cursor.type.get_canonical().spelling
        return re.sub(r"\b(const|class|struct)\b|[&*]", "", text).strip()

    def look_at_call(self, call):
        target = call.referenced
        scope = (
            target.semantic_parent.spelling if target is not None and target.semantic_parent else ""
        )
        name = call.spelling
        arguments = self.arguments(call)
        if scope == "ros" and name == "init":
            options = arguments[3] if len(arguments) > 3 else None
            anonymous = options is not None and any(
                "AnonymousName" in t.spelling for t in options.get_tokens()
            )
            self.add(
                call,
                "init",
                self.value(arguments[2]) if len(arguments) > 2 else None,
                anonymous=anonymous or None,
                offset=call.extent.start.offset,
            )
        elif name == "advertise" and scope == "NodeHandle":
            self.add_topic(call, "publisher", arguments, latch=self.optional(arguments, 2))
        elif name == "subscribe" and scope == "NodeHandle":
            self.add_topic(call, "subscriber", arguments)
        elif (
            name in ("createTimer", "createWallTimer", "createSteadyTimer")
            and scope == "NodeHandle"
        ):
            self.add(
                call, "timer", period=self.period(arguments), oneshot=self.optional(arguments, 3)
            )
        elif (
            name in ("Rate", "WallRate")
            and target is not None
            and target.kind == self.kinds.CONSTRUCTOR
        ):
            rate = self.value(arguments[0]) if arguments else None
            if isinstance(rate, (int, float)) and rate:
                self.add(call, "timer", period=1 / rate)
        elif name == "publish" and (
            scope == "Publisher" or "Publisher" in self.type_of(self.base(call))
        ):
            self.add(call, "publish")
        elif name in _SPINS and (
            scope in ("ros",) or "Spinner" in scope or scope == "CallbackQueue"
        ):
            self.add(call, "spin", name)
        elif name in ("exit", "_exit", "quick_exit", "abort", "shutdown", "requestShutdown"):
            self.add(call, "exit", name, code=self.value(arguments[0]) if arguments else None)
        elif name in ("signal", "sigaction"):
            self.add(call, "signal", name)
        elif name in ("sleep", "usleep", "sleep_for"):
            self.add(call, "sleep", name)
        elif name in ("printf", "puts") and scope in ("", "std"):
            text = self.value(arguments[0]) if arguments else None
            self.add(call, "print", percent(text) if isinstance(text, str) else None)
        if name in _KEPT and scope == "NodeHandle":
            self.look_at_kept(call)

    def optional(self, arguments, index):
        return self.value(arguments[index]) if index < len(arguments) else None

    def period(self, arguments):
        value = self.value(arguments[0]) if arguments else None
        return value if isinstance(value, (int, float)) else None

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
                [self.value(child) for child in self.arguments(made)]
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
                found = _MESSAGE.search(text)
                if found:
                    return "/".join(found.groups())
        for argument in arguments[2:]:
            for cursor in (argument, self.peel(argument)):
                found = _MESSAGE.search(cursor.type.get_canonical().spelling)
                if found:
                    return "/".join(found.groups())
        if kind == "subscriber" and call.referenced is not None:
            found = _MESSAGE.search(call.referenced.type.get_canonical().spelling)
            return "/".join(found.groups()) if found else None
        return None

    def look_at_kept(self, call):
        """Note what is made and not kept: it ends at once, or with its function."""
        kinds = self.kinds
        for parent in self.above(call):
            # The second is as in (void)nh.subscribe(...).
            if parent.kind in (kinds.UNEXPOSED_EXPR, kinds.CSTYLE_CAST_EXPR):
                continue
            if parent.kind == kinds.COMPOUND_STMT:
                self.add(call, "discarded", call.spelling)
            elif (
                parent.kind == kinds.VAR_DECL
                or parent.kind == kinds.CALL_EXPR
                and (
                    self.parents.get(parent.hash) is not None
                    and self.parents[parent.hash].kind == kinds.VAR_DECL
                )
            ):
                variable = parent if parent.kind == kinds.VAR_DECL else self.parents[parent.hash]
                function = self.function(variable)
                is_static = any(t.spelling == "static" for t in variable.get_tokens())
                if (
                    function is not None
                    and function.spelling != "main"
                    and not is_static
                    and not self.is_handed_on(variable)
                    and not self.waits(function)
                ):
                    self.add(
                        call,
                        "local",
                        call.spelling,
                        name=variable.spelling,
                        function=function.spelling,
                    )
            break

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

    def look_at_operator(self, cursor):
        children = list(cursor.get_children())
        if not children:
            return
        left = self.peel(children[0])
        target = left.referenced
        if cursor.kind == self.kinds.UNARY_OPERATOR:
            tokens = [t.spelling for t in cursor.get_tokens()]
            step = 1 if "++" in tokens else -1 if "--" in tokens else None
            if step and target is not None:
                self.add_counter(cursor, target, step)
            return
        if len(children) != 2:
            return
        operator = self.operator(cursor, children)
        if cursor.kind == self.kinds.COMPOUND_ASSIGNMENT_OPERATOR:
            step = self.value(children[1])
            if operator == "%=" and target is not None:
                self.add_reset(cursor, target, step, 0)
            if operator in ("+=", "-=") and target is not None:
                sign = 1 if operator == "+=" else -1
                self.add_counter(
                    cursor, target, sign * step if isinstance(step, (int, float)) else None
                )
        elif operator == "=" and target is not None:
            if left.kind == self.kinds.MEMBER_REF_EXPR and _MESSAGE.search(
                (next(left.get_children(), left)).type.get_canonical().spelling
            ):
                names = [
                    c.spelling
                    for c in children[1].walk_preorder()
                    if c.kind in (self.kinds.DECL_REF_EXPR, self.kinds.MEMBER_REF_EXPR)
                ]
                self.add(cursor, "data", value=self.value(children[1]), names=names)
            elif any(
                c.referenced == target
                for c in children[1].walk_preorder()
                if c.kind in (self.kinds.DECL_REF_EXPR, self.kinds.MEMBER_REF_EXPR)
            ):
                steps = [
                    self.value(list(c.get_children())[1])
                    for c in children[1].walk_preorder()
                    if c.kind == self.kinds.BINARY_OPERATOR
                    and len(list(c.get_children())) == 2
                    and self.operator(c, list(c.get_children())) == "+"
                ]
                self.add_counter(cursor, target, steps[0] if steps else None)
                for c in children[1].walk_preorder():
                    if c.kind == self.kinds.BINARY_OPERATOR:
                        inside = list(c.get_children())
                        if self.operator(c, inside) == "%":
                            self.add_reset(cursor, target, self.value(inside[1]), 0)

    def look_at_reset(self, cursor):
        """Look for `if (counter > LIMIT) counter = VALUE`, and the same with `? :`."""
        condition, then, *_ = cursor.get_children()
        condition = self.peel(condition)
        sides = list(condition.get_children())
        if condition.kind != self.kinds.BINARY_OPERATOR or len(sides) != 2:
            return
        counter, limit = self.peel(sides[0]).referenced, self.value(sides[1])
        if counter is None or self.operator(condition, sides) not in (">", ">=", "=="):
            return
        if cursor.kind == self.kinds.CONDITIONAL_OPERATOR:
            wrapping = (self.kinds.UNEXPOSED_EXPR, self.kinds.PAREN_EXPR)
            above = next((p for p in self.above(cursor) if p.kind not in wrapping), None)
            if above is not None and self.given(above, counter) is not None:
                self.add_reset(cursor, counter, limit, self.value(then))
            return
        for one in then.walk_preorder():
            given = self.given(one, counter)
            if given is not None:
                self.add_reset(one, counter, limit, self.value(given))

    def given(self, cursor, variable):
        """Return the right side of `variable = ...`, or None if the expression is another."""
        sides = list(cursor.get_children())
        if cursor.kind != self.kinds.BINARY_OPERATOR or len(sides) != 2:
            return None
        is_given = self.operator(cursor, sides) == "="
        return sides[1] if is_given and self.peel(sides[0]).referenced == variable else None

    def add_reset(self, cursor, counter, limit, value):
        if isinstance(limit, int) and isinstance(value, int):
            self.add(cursor, "reset", counter.spelling, limit=limit, value=value)

    def add_counter(self, cursor, target, step):
        size = target.type.get_size()
        kind = self.type_of(target)
        self.add(cursor, "step", target.spelling, step=step, type=kind, bits=8 * size)
        first = self.initial(target)
        if first is not None:
            value = self.value(first)
            if isinstance(value, (int, float)):
                self.add(target, "counter", target.spelling, value=value, type=kind, bits=8 * size)

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


def number(token):
    """Return the number that a C++ literal stands for, or None."""
    text = token.lower()
    if text.startswith("0x"):
        text = text.rstrip("ul")
    else:
        text = text.rstrip("ulf")
    try:
        return int(text, 0) if re.fullmatch(r"0x[0-9a-f]+|\d+", text) else float(text)
    except ValueError:
        return None


def arithmetic(operator, left, right):
    if not all(isinstance(side, (int, float)) and abs(side) < 2**70 for side in (left, right)):
        return None
    if operator == "+":
        return left + right
    if operator == "-":
        return left - right
    if operator == "*":
        return left * right
    if operator == "/" and right:
        whole = isinstance(left, int) and isinstance(right, int)
        return left // right if whole else left / right
    return None


def logged(macro, tokens):
    """Return the text of a ROS_INFO... with GAP for each value in it."""
    depth, parts, current = 0, [], []
    for token in tokens[1:]:
        if token in ("(", "[", "{"):
            depth += 1
            if depth == 1:
                continue
        elif token in (")", "]", "}"):
            depth -= 1
            if depth == 0:
                break
        if token == "," and depth == 1:
            parts.append(current)
            current = []
        else:
            current.append(token)
    parts.append(current)
    # Before the text stand, of some macros, a condition, a period or a name.
    skip = sum(word in macro for word in ("_COND", "_THROTTLE", "_NAMED", "_DELAYED"))
    if "_STREAM" in macro:
        # A comma of a template's arguments is none between arguments: the rest is the text.
        pieces, piece = [], []
        for token in [t for part in parts[skip:] for t in [*part, ","]][:-1]:
            if token == "<<":
                pieces.append(piece)
                piece = []
            else:
                piece.append(token)
        pieces.append(piece)
        return "".join(literal(piece) for piece in pieces)
    if skip >= len(parts):
        return None
    text = literal(parts[skip])
    return percent(text) if text != GAP else None


def literal(tokens):
    """Return the text of string literals, one after another, or GAP for anything else."""
    try:
        texts = [json.loads(token, strict=False) for token in tokens]
    except ValueError:
        return GAP
    return "".join(texts) if texts and all(isinstance(t, str) for t in texts) else GAP


def percent(text):
    return re.sub(r"%[-+ #0-9.*]*(?:hh|ll|[hlzjtL])?[a-zA-Z]", GAP, text).replace("%%", "%")


if __name__ == "__main__":
    main()
