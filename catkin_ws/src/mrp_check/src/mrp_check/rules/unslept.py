# SPDX-License-Identifier: BSD-3-Clause
"""rospy: what sleep() raises at the end is caught. It raises where time is simulated alone.

https://docs.ros.org/en/noetic/api/rospy/html/rospy.timer-module.html#sleep
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import NOTE, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources.python_rule import PythonRule, of_sources


class Unslept(PythonRule):
    def findings(self) -> Iterator[Finding]:
        caught = {"ROSInterruptException", "ROSException"} & self.source.names()
        for call in self.source.nodes(ast.Call) if not caught else ():
            if self._is_of_rospy(call) and not self.source.is_guarded(call):
                yield self.finding(
                    "exit",
                    "Where time is simulated, as Gazebo does, sleep() raises a"
                    " ROSInterruptException on Ctrl-C, and nothing catches it: the node ends with a"
                    " traceback.",
                    call,
                    severity=NOTE,
                    expected="try and except rospy.ROSInterruptException",
                    fix="Catch it around the loop.",
                )
                return

    def _is_of_rospy(self, call: ast.Call) -> bool:
        """Return whether a call is that of rospy.sleep(), or of a rospy.Rate's sleep()."""
        function = call.func
        if self.source.dotted(function) == "rospy.sleep":
            return True
        if not isinstance(function, ast.Attribute) or function.attr != "sleep":
            return False
        made = self.source.stored(self.source.key(function.value))
        calls = [one for one in made if isinstance(one, ast.Call)]
        return any(self.source.dotted(one.func) == "rospy.Rate" for one in calls)


RULE = Rule("static", 121, ("facts",), of_sources(Unslept), also=("exit",), only=ANY)
