#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The nodes of the labs end at once when a parameter is wrong, and say so in one sentence."""

import contextlib
import unittest

import rosgraph
import rostest
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process

WHOLE = "a whole number, 0 or more"
# Parameters, and what the nodes say of the wrong one, after its name.
WRONG = (
    ({"topic": 1}, "is 1, but must be a text"),
    ({"queue_size": -1}, f"is -1, but must be {WHOLE}"),
    ({"burst": True}, f"is .*, but must be {WHOLE}"),
    ({"start": "one"}, f"is one, but must be {WHOLE}"),
    ({"period": -0.5}, "is -0.5, but must be a number of seconds, 0 or more"),
    ({"latch": 1}, "is 1, but must be true or false"),
    ({"timer": "sundial"}, "is sundial, but must be one of ros "),
    ({"values": 1}, "is 1, but must be a list"),
    ({"topics": ["one", "two"]}, "is .*, but must be a struct of topics"),
    ({"count": -1, "topics": {"one": {"count": 2}, "two": {}}}, f"is -1, but must be {WHOLE}"),
    ({"qeue_size": 1}, "is not known, only ~burst ~count ~first_burst "),
)


class TestParameters(unittest.TestCase):
    def check(self, executable, expected, before="parameter ~"):
        """Start a node for each of (parameters, sentence): it must end with that sentence."""
        master = rosgraph.Master("/test_parameters")
        with contextlib.ExitStack() as stack:
            nodes = []
            for number, (parameters, sentence) in enumerate(expected):
                master.setParam(f"/node{number}", parameters)
                stack.callback(master.deleteParam, f"/node{number}")
                command = (program(PACKAGE, executable), f"__name:=node{number}")
                node = stack.enter_context(Process(*command, extra_env=LIVE))
                nodes.append((node, f"/node{number}: {before}{sentence}"))
            for node, sentence in nodes:
                self.assertEqual(node.wait(), 1, str(node))
                self.assertRegex(str(node), sentence)
                self.assertNotIn("Traceback", str(node))

    def check_publisher(self, executable):
        wrong = [(parameters, f"{[*parameters][0]} {words}") for parameters, words in WRONG]
        self.check(executable, wrong)
        self.check(executable, [({"values": ["x"]}, r".*\bx\b")], before="")

    def test_publisher_cpp(self):
        self.check_publisher("lab_publisher_cpp_node")

    def test_publisher_py(self):
        self.check_publisher("lab_publisher_py_node.py")

    def test_the_others_read_theirs_in_the_same_way(self):
        self.check("lab_subscriber_cpp_node", [({"threads": -1}, f"threads is -1, .* {WHOLE}")])
        self.check(
            "lab_subscriber_py_node.py", [({"buff_size": -1}, f"buff_size is -1, .* {WHOLE}")]
        )
        known = "jmp is not known, only ~factor ~jump ~jump_every ~period"
        self.check("lab_clock_py_node.py", [({"jmp": 1}, known)])


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "parameters", TestParameters)
