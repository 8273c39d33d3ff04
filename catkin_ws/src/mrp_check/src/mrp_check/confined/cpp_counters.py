# SPDX-License-Identifier: BSD-3-Clause
"""How a C++ source counts: steps, first values, and where a counter starts over."""

from __future__ import annotations

from mrp_check.confined.cpp_expressions import MESSAGE, Cursor, Unit
from mrp_check.confined.places import Kind, Plain


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
            elif cursor.kind == self.kinds.COMPOUND_ASSIGNMENT_OPERATOR:
                self.look_at_step(cursor, target, operator, self.value(children[1]))

    def look_at_step(self, cursor: Cursor, target: Cursor, operator: str, step: Plain) -> None:
        if operator == "%=":
            self.add_reset(cursor, target, step, 0)
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
            for one in inside:
                sides = list(one.get_children()) if one.kind == kinds.BINARY_OPERATOR else []
                if len(sides) == 2 and self.operator(one, sides) == "%":
                    self.add_reset(cursor, target, self.value(sides[1]), 0)

    def look_at_reset(self, cursor: Cursor) -> None:
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

    def given(self, cursor: Cursor, variable: Cursor) -> Cursor | None:
        """Return the right side of `variable = ...`, or None if the expression is another."""
        sides = list(cursor.get_children())
        if cursor.kind != self.kinds.BINARY_OPERATOR or len(sides) != 2:
            return None
        is_given = self.operator(cursor, sides) == "="
        return sides[1] if is_given and self.names(self.peel(sides[0]), variable) else None

    def add_reset(self, cursor: Cursor, counter: Cursor, limit: Plain, value: Plain) -> None:
        if isinstance(limit, int) and isinstance(value, int):
            self.add(cursor, Kind.RESET, counter.spelling, limit=limit, value=value)

    def add_counter(self, cursor: Cursor, target: Cursor) -> None:
        bits, type_ = 8 * target.type.get_size(), self.type_of(target)
        self.add(cursor, Kind.STEP, target.spelling, type=type_, bits=bits)
        first = self.initial(target)
        if first is not None and isinstance(self.value(first), (int, float)):
            self.add(target, Kind.COUNTER, target.spelling)
