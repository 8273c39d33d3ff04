# SPDX-License-Identifier: BSD-3-Clause
"""What rospy.Timer() and rospy.Subscriber() return is kept: else nobody can stop it. And a
publisher is made once."""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Rule

_CALLING = ("rospy.Timer", "rospy.Subscriber")  # each calls a function, again and again
_ANSWERING = ("rospy.Service", "actionlib.SimpleActionServer")  # so does each of these
# What a loop is not to do anew in each turn -> what is said of it, what is expected, and the fix.
_IN_LOOPS = {
    "rospy.Subscriber": (
        "Each turn of the loop makes one more subscriber, and rospy keeps all: each message is"
        " handled once more than before.",
        "a subscriber that is made once, before the loop",
        "Move it to before the loop.",
    ),
    "rospy.wait_for_message": (
        "Each turn of the loop makes a subscriber, waits for one message, and drops it: what comes"
        " in between is missed, and each turn waits for a connection.",
        "a subscriber that is made once, and whose callback keeps the message",
        "Subscribe before the loop, and read what the callback has kept.",
    ),
}
_AROUND = (ast.While, ast.For, ast.If, ast.Try, ast.FunctionDef, ast.Lambda)


class NotKept(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Expr):
            call = node.value
            name = self.source.dotted(call.func) if isinstance(call, ast.Call) else None
            if name == "rospy.Publisher":
                yield self.finding(
                    "lifetime",
                    "What rospy.Publisher() returns is not kept: nothing can publish with it.",
                    node,
                    certainty=HABIT,
                    expected="a publisher that is kept: publisher = rospy.Publisher(...)",
                    fix="Keep it, and call its publish(); or take it out.",
                )
        yield from self._publishers()
        yield from self._in_loops()

    def _in_loops(self) -> Iterator[Finding]:
        """Yield a warning for each subscriber that a loop makes anew in each turn."""
        for call in self.source.nodes(ast.Call):
            said = _IN_LOOPS.get(self.source.dotted(call.func) or "")
            around = (one for one in self.source.above(call) if isinstance(one, _AROUND))
            loop = next(around, self.source.tree)
            leaves = any(isinstance(one, ast.Break) for one in ast.walk(loop))
            if said and isinstance(loop, ast.While) and not leaves:
                message, expected, fix = said
                yield self.finding(
                    "lifetime", message, call, certainty=HABIT, expected=expected, fix=fix
                )

    def _publishers(self) -> Iterator[Finding]:
        """Yield a warning for each publisher that is made anew whenever a callback is called."""
        takes = (*_CALLING, *_ANSWERING)
        called = self.handed_over(lambda call: self.source.dotted(call.func) in takes)
        for call in self.source.nodes(ast.Call):
            function = self.source.function(call)
            if self.source.dotted(call.func) != "rospy.Publisher" or function not in called:
                continue
            is_asked = any(isinstance(one, ast.If) for one in self.source.above(call))
            if isinstance(function, ast.FunctionDef) and not is_asked:
                yield self.finding(
                    "lifetime",
                    f"{function.name}() makes a publisher each time that it is called: a new one is"
                    " connected to nobody yet, so what it publishes at once is lost.",
                    call,
                    certainty=HABIT,
                    expected="a publisher that is made once, before the subscriber",
                    fix="Make it outside of the callback, and use it there.",
                )


RULE = Rule("static", ("facts",), of_sources(NotKept), also=("lifetime",))
