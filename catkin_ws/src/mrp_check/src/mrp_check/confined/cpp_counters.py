# SPDX-License-Identifier: BSD-3-Clause
"""How a C++ source counts: steps and first values."""

from __future__ import annotations

from mrp_check.confined.cpp_expressions import MESSAGE, Cursor, Unit
from mrp_check.confined.places import Kind


class Counters(Unit):
    def look_at_operator(self, cursor: Cursor) -> None:
        children = list(cursor.get_children())
        target = self.peel(children[0]).referenced if children else None
        if target is None:
            return
        if cursor.kind == self.kinds.UNARY_OPERATOR:
            if {"++", "--"} & {token.spelling for token in cursor.get_tokens()}:
                self.add_counter(cursor, target)
        elif len(children) == 2:
            operator = self.operator(cursor, children)
            if operator == "=":
                self.look_at_assignment(cursor, self.peel(children[0]), children[1])
            elif operator in ("+=", "-="):
                self.add_counter(cursor, target)

    def look_at_assignment(self, cursor: Cursor, left: Cursor, right: Cursor) -> None:
        """Look for MESSAGE.data = ..., and for counter = counter + 2 and the like."""
        kinds, target = self.kinds, left.referenced
        inside = list(right.walk_preorder())
        variables = [c for c in inside if c.kind in (kinds.DECL_REF_EXPR, kinds.MEMBER_REF_EXPR)]
        owner = next(left.get_children(), left)
        is_member = left.kind == kinds.MEMBER_REF_EXPR
        if is_member and MESSAGE.search(owner.type.get_canonical().spelling):
            names = [c.spelling for c in variables]
            self.add(cursor, Kind.DATA, names=names)
        elif any(self.names(c, target) for c in variables):
            self.add_counter(cursor, target)

    def add_counter(self, cursor: Cursor, target: Cursor) -> None:
        bits, type_ = 8 * target.type.get_size(), self.type_of(target)
        self.add(cursor, Kind.STEP, target.spelling, type=type_, bits=bits)
        first = self.initial(target)
        if first is not None and isinstance(self.value(first), (int, float)):
            self.add(target, Kind.COUNTER, target.spelling)
