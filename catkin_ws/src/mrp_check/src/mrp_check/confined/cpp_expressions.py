# SPDX-License-Identifier: BSD-3-Clause
"""What clang makes of a C++ source: its cursors, and which of its expressions are plain."""

from __future__ import annotations

import functools
import json
import os
import re
import types
from typing import Any, Callable, Iterator, Sequence

from mrp_check.confined.places import Kind, Place, Plain
from mrp_check.confined.seen import Number

GAP = "{}"  # what stands in a text for a part that the source does not say plainly
_LARGEST = 2**70  # of a number that is still counted with
# A message's type, as clang spells it.
MESSAGE = re.compile(r"\b(\w+)::(\w+?)_<")
_NAMES_ALONE = {"TYPE_REF", "NAMESPACE_REF", "TEMPLATE_REF"}
_WRAPPING = {
    "UNEXPOSED_EXPR",
    "PAREN_EXPR",
    "CSTYLE_CAST_EXPR",
    "CXX_STATIC_CAST_EXPR",
    "CXX_FUNCTIONAL_CAST_EXPR",
    "INIT_LIST_EXPR",
}
# Made of one argument, they stand for it; also where clang does not know what is called.
_CONSTRUCTORS = set("basic_string Duration WallDuration Rate WallRate SteadyDuration move".split())
_FUNCTIONS = {
    "FUNCTION_DECL",
    "CXX_METHOD",
    "CONSTRUCTOR",
    "LAMBDA_EXPR",
    "DESTRUCTOR",
    "FUNCTION_TEMPLATE",
}


Cursor = Any  # clang's: it comes without types


class Unit:
    """One source that clang has read, with all of the package that it includes."""

    def __init__(self, cindex: types.ModuleType, folder: str, unit: Cursor) -> None:
        self.kinds = cindex.CursorKind
        self.folder, self.unit = folder, unit
        self.places: list[Place] = []
        self.parents: dict[int, Cursor | None] = {}
        self.uses: dict[int, int] = {}  # variable -> how often it is named
        self.named: set[str] = set()  # functions that are named
        self.cursors: list[Cursor] = []
        for cursor in self.unit.cursor.get_children():
            if self.own_file(cursor):
                self.collect(cursor, None)

    def path(self, file: Cursor) -> str | None:
        path = os.path.normpath(file.name) if file else ""
        return os.path.relpath(path, self.folder) if path.startswith(self.folder + "/") else None

    def own_file(self, cursor: Cursor) -> str | None:
        return self.path(cursor.location.file)

    def collect(self, cursor: Cursor, parent: Cursor | None, depth: int = 0) -> None:
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

    def above(self, cursor: Cursor) -> Iterator[Cursor]:
        parent = self.parents.get(cursor.hash)
        while parent is not None:
            yield parent
            parent = self.parents.get(parent.hash)

    def add(self, cursor: Cursor, kind: Kind, text: Plain = None, **values: Any) -> None:
        file = self.own_file(cursor)
        if file:
            plain = text if isinstance(text, str) and text.replace(GAP, "") else None
            self.places.append(Place(file, cursor.location.line, kind, plain, **values))

    # What an expression says plainly.

    def peel(self, cursor: Cursor) -> Cursor:
        """Return the expression without casts, brackets and constructors of one argument."""
        while True:
            children = [c for c in cursor.get_children() if c.kind.name not in _NAMES_ALONE]
            if self.constructs(cursor):
                children = [
                    c for c in children if c.location.line or c.kind != self.kinds.UNEXPOSED_EXPR
                ]
                if cursor.spelling == "basic_string":
                    children = children[:1]
                if cursor.spelling == "move":
                    children = children[1:]
            elif cursor.kind.name not in _WRAPPING:
                return cursor
            if len(children) != 1:
                return cursor
            cursor = children[0]

    def constructs(self, cursor: Cursor) -> bool:
        """Return whether an expression makes an object of its arguments."""
        if cursor.kind != self.kinds.CALL_EXPR:
            return False
        target = cursor.referenced
        made = target is not None and target.kind == self.kinds.CONSTRUCTOR
        return made or cursor.spelling in _CONSTRUCTORS

    def value(self, cursor: Cursor | None, depth: int = 0) -> Plain:
        """Return the plain number, truth value or text of an expression, or None."""
        if cursor is None or depth > 12:
            return None
        cursor = self.peel(cursor)
        of_kind = _VALUES.get(cursor.kind.name)
        return of_kind(self, cursor, depth + 1) if of_kind else None

    def _first_token(self, cursor: Cursor) -> str:
        return next((token.spelling for token in cursor.get_tokens()), "")

    def _text(self, cursor: Cursor, depth: int) -> Plain:
        try:
            return str(json.loads(cursor.spelling, strict=False))
        except ValueError:
            return None

    def _number(self, cursor: Cursor, depth: int) -> Plain:
        return _number(self._first_token(cursor).replace("'", ""))

    def _truth(self, cursor: Cursor, depth: int) -> bool:
        return self._first_token(cursor) == "true"

    def _variable(self, cursor: Cursor, depth: int) -> Plain:
        target, kinds = cursor.referenced, self.kinds
        if target is None or target.kind not in (kinds.VAR_DECL, kinds.FIELD_DECL):
            return None
        return None if target.hash in self.changed else self.value(self.initial(target), depth)

    def _unary(self, cursor: Cursor, depth: int) -> Plain:
        inside = self.value(next(cursor.get_children(), None), depth)
        is_minus = self._first_token(cursor) == "-"
        return -inside if is_minus and isinstance(inside, (int, float)) else None

    def _binary(self, cursor: Cursor, depth: int) -> Plain:
        children = list(cursor.get_children())
        if len(children) != 2:
            return None
        left, right = (self.value(child, depth) for child in children)
        return _arithmetic(self.operator(cursor, children), left, right)

    def _call(self, cursor: Cursor, depth: int) -> Plain:
        children = list(cursor.get_children())
        if cursor.spelling == "operator+" and len(children) == 3:
            # the left, the operator, the right
            parts = [self.value(child, depth) for child in (children[0], children[2])]
            if any(isinstance(part, str) for part in parts):
                return "".join(part if isinstance(part, str) else GAP for part in parts)
        if cursor.spelling in ("resolveName", "resolve") and len(children) > 1:
            return self.value(children[1], depth)
        return None

    @functools.cached_property
    def changed(self) -> set[int]:
        """Variables that are given a value in more places than their declaration."""
        changed, kinds = set(), self.kinds
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
                changed.add(target.hash)
        return changed

    def operator(self, cursor: Cursor, children: Sequence[Cursor]) -> str:
        end = children[0].extent.end.offset
        for token in cursor.get_tokens():
            if token.extent.start.offset >= end:
                return str(token.spelling)
        return ""

    def initial(self, declaration: Cursor) -> Cursor | None:
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

    def function(self, cursor: Cursor) -> Cursor | None:
        """Return the function in which a cursor stands, or None."""
        return next((outer for outer in self.above(cursor) if outer.kind.name in _FUNCTIONS), None)

    def base(self, call: Cursor) -> Cursor | None:
        """Return the expression before the dot of a call, or None."""
        member = next(call.get_children(), None)
        if member is None or member.kind != self.kinds.MEMBER_REF_EXPR:
            return None
        return next(member.get_children(), None)

    def names(self, expression: Cursor, target: Cursor | None) -> bool:
        """Return whether an expression names what is declared at a cursor."""
        named = expression.referenced  # None in a template; clang cannot compare with that
        return named is not None and target is not None and bool(named == target)

    def type_of(self, cursor: Cursor | None) -> str:
        if cursor is None:
            return ""
        text = cursor.type.get_canonical().spelling
        return re.sub(r"\b(const|class|struct)\b|[&*]", "", text).strip()

    def is_loop(self, cursor: Cursor) -> bool:
        """Return whether it is a loop of the source's own: those of ROS_INFO are none."""
        kinds = self.kinds
        if cursor.kind not in (kinds.WHILE_STMT, kinds.DO_STMT, kinds.FOR_STMT):
            return False
        first = next((token.spelling for token in cursor.get_tokens()), "")
        return first in ("while", "do", "for")


def _number(token: str) -> Number | None:
    """Return the number that a C++ literal stands for, or None."""
    text = token.lower()
    text = text.rstrip("ul" if text.startswith("0x") else "ulf")
    try:
        return int(text, 0) if re.fullmatch(r"0x[0-9a-f]+|\d+", text) else float(text)
    except ValueError:
        return None


def _arithmetic(operator: str, left: Plain, right: Plain) -> Number | None:
    if not isinstance(left, (int, float)) or not isinstance(right, (int, float)):
        return None
    if max(abs(left), abs(right)) >= _LARGEST:
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


# kind of an expression -> what finds its value
_VALUES: dict[str, Callable[[Unit, Cursor, int], Plain]] = {
    "STRING_LITERAL": Unit._text,
    "INTEGER_LITERAL": Unit._number,
    "FLOATING_LITERAL": Unit._number,
    "CXX_BOOL_LITERAL_EXPR": Unit._truth,
    "DECL_REF_EXPR": Unit._variable,
    "MEMBER_REF_EXPR": Unit._variable,
    "UNARY_OPERATOR": Unit._unary,
    "BINARY_OPERATOR": Unit._binary,
    "CALL_EXPR": Unit._call,
}
