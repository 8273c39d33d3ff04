# SPDX-License-Identifier: BSD-3-Clause
"""What rospy.Timer() and rospy.Subscriber() return is kept: else nobody can stop it."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import NOTE, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources.python_rule import PythonRule, of_sources


class NotKept(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Expr):
            call = node.value
            name = self.source.dotted(call.func) if isinstance(call, ast.Call) else None
            if name in ("rospy.Timer", "rospy.Subscriber"):
                yield self.finding(
                    "lifetime",
                    f"What {name}() returns is not kept. rospy keeps it going all the same; but"
                    " nothing can stop it.",
                    node,
                    severity=NOTE,
                    expected="a member, such as self.timer or self.subscriber",
                    fix="Keep it as a member.",
                )


RULE = Rule("static", 25, ("facts",), of_sources(NotKept), also=("lifetime",))
