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

TOPICS = "a struct of topics, each with a struct of parameters"
# Parameters, and what the nodes say of the wrong one, after its value.
WRONG = (
    ({"topic": ""}, "a string that is not empty"),
    (
        {"topic": "a topic"},
        "a topic's name: letters, digits, _ and /, with a letter, / or ~ in front",
    ),
    ({"queue_size": -1}, "a whole number, 0 or more"),
    ({"burst": True}, "a whole number, 1 or more"),
    ({"start": "one"}, "a whole number"),
    ({"period": -0.5}, "a number of seconds, 0 or more"),
    ({"latch": 1}, "true or false"),
    ({"timer": "sundial"}, "one of ros, "),
    ({"values": [1, 2]}, "a list of strings"),
    ({"values": ["1", "x"]}, "a list of texts of std_msgs/UInt32 messages"),
    ({"topics": ["one", "two"]}, TOPICS),
    ({"topics": {"one": {}, "two": 2}}, TOPICS),
    ({"count": -1, "topics": {"one": {"count": 2}, "two": {}}}, "a whole number, 0 or more"),
)


class TestParameters(unittest.TestCase):
    def check(self, executable, expected):
        """Start a node for each of (parameters, sentence): it must end with that sentence."""
        master = rosgraph.Master("/test_parameters")
        with contextlib.ExitStack() as stack:
            nodes = []
            for number, (parameters, sentence) in enumerate(expected):
                master.setParam(f"/node{number}", parameters)
                stack.callback(master.deleteParam, f"/node{number}")
                command = (program(PACKAGE, executable), f"__name:=node{number}")
                node = stack.enter_context(Process(*command, extra_env=LIVE))
                nodes.append((node, f"/node{number}: parameter ~{sentence}"))
            for node, sentence in nodes:
                self.assertEqual(node.wait(), 1, str(node))
                self.assertRegex(str(node), sentence)
                self.assertNotIn("Traceback", str(node))

    def check_publisher(self, executable):
        self.check(
            executable,
            [
                *((wrong, f"{[*wrong][0]} is .*, but must be {words}") for wrong, words in WRONG),
                ({"qeue_size": 1}, "qeue_size is not known, only ~burst, ~count, ~delay, "),
            ],
        )

    def test_publisher_cpp(self):
        self.check_publisher("lab_publisher_cpp_node")

    def test_publisher_py(self):
        self.check_publisher("lab_publisher_py_node.py")

    def test_the_others_read_theirs_in_the_same_way(self):
        threads = "threads is 0, but must be a whole number, 1 or more"
        self.check("lab_subscriber_cpp_node", [({"threads": 0}, threads)])
        buff_size = "buff_size is 0, but must be a whole number, 1 or more"
        self.check("lab_subscriber_py_node.py", [({"buff_size": 0}, buff_size)])
        known = "jmp is not known, only ~begin, ~factor, ~jump, ~jump_every, ~period"
        self.check("lab_clock_py_node.py", [({"jmp": 1}, known)])


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "parameters", TestParameters)
