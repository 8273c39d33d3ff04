# SPDX-License-Identifier: BSD-3-Clause
"""A Python program starts its node once: a callback that starts it again raises an error.

https://docs.ros.org/en/noetic/api/rospy/html/rospy-module.html#init_node
"""

from __future__ import annotations

import ast
from typing import Iterator

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.rules.unheard import in_threads
from mrp_check.sources.python_rule import PythonRule, of_sources


class InitAgain(PythonRule):
    def findings(self) -> Iterator[Finding]:
        within = in_threads(self.source)
        starts = [
            call
            for call in self.source.nodes(ast.Call)
            if self.source.dotted(call.func) == "rospy.init_node"
        ]
        again = [call for call in starts if self.source.function(call) in within]
        for call in again if len(again) < len(starts) else ():
            if not self.source.is_guarded(call, "ROSException"):
                yield self.finding(
                    "node-start",
                    "A callback comes here when the node has long been started: rospy.init_node()"
                    " raises an error if it is called again with other arguments.",
                    call,
                    expected="one rospy.init_node(), where the program begins",
                    fix="Take this line out.",
                )


RULE = Rule("static", 107, ("facts",), of_sources(InitAgain), also=("node-start",), only=ANY)
