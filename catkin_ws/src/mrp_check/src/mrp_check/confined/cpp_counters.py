# SPDX-License-Identifier: BSD-3-Clause
"""How a C++ source counts: steps, first values, and where a counter begins anew."""

from __future__ import annotations

from mrp_check.confined.cpp_expressions import MESSAGE, Unit


class Counters(Unit):
    def look_at_operator(self, cursor):
        children = list(cursor.get_children())
        target = self.peel(children[0]).referenced if children else None
        if target is None:
            return
        if cursor.kind == self.kinds.UNARY_OPERATOR:
            tokens = [t.spelling for t in cursor.get_tokens()]
            step = 1 if "++" in tokens else -1 if "--" in tokens else None
            if step:
                self.add_counter(cursor, target, step)
        elif len(children) == 2:
            operator = self.operator(cursor, children)
            if operator == "=":
                self.look_at_assignment(cursor, self.peel(children[0]), children[1])
            elif cursor.kind == self.kinds.COMPOUND_ASSIGNMENT_OPERATOR:
                self.look_at_step(cursor, target, operator, self.value(children[1]))

    def look_at_step(self, cursor, target, operator, step):
        if operator == "%=":
            self.add_reset(cursor, target, step, 0)
        elif operator in ("+=", "-="):
            sign = 1 if operator == "+=" else -1
            plain = isinstance(step, (int, float))
            self.add_counter(cursor, target, sign * step if plain else None)

    def look_at_assignment(self, cursor, left, right):
        """Look for MESSAGE.data = ..., and for counter = counter + 2 and the like."""
        kinds, target = self.kinds, left.referenced
        inside = list(right.walk_preorder())
        variables = [c for c in inside if c.kind in (kinds.DECL_REF_EXPR, kinds.MEMBER_REF_EXPR)]
        owner = next(left.get_children(), left)
        is_member = left.kind == kinds.MEMBER_REF_EXPR
        if is_member and MESSAGE.search(owner.type.get_canonical().spelling):
            names = [c.spelling for c in variables]
            self.add(cursor, "data", value=self.value(right), names=names)
        elif any(c.referenced == target for c in variables):
            binary = [
                (c, list(c.get_children())) for c in inside if c.kind == kinds.BINARY_OPERATOR
            ]
            of = {"+": [], "%": []}
            for one, sides in binary:
                if len(sides) == 2:
                    of.setdefault(self.operator(one, sides), []).append(sides[1])
            self.add_counter(cursor, target, self.value(of["+"][0]) if of["+"] else None)
            for limit in of["%"]:
                self.add_reset(cursor, target, self.value(limit), 0)

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
