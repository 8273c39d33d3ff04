#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The nodes of the labs end at once when a parameter is wrong, and say so in one sentence."""

import json
import unittest

import rosgraph
import rostest
from forked import Forked, Whole
from mrp_labs.message_text import MESSAGE_TYPES
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program

PUBLISHERS = ("lab_publisher_cpp_node", "lab_publisher_py_node.py")
CLOCK = ("lab_clock_py_node.py",)
SUBSCRIBERS = ("lab_subscriber_cpp_node", "lab_subscriber_py_node.py")

AT_ONCE = 8  # nodes that run at the same time

ANY_NUMBER = "a whole number"
NUMBER = ANY_NUMBER + ", 0 or more"
POSITIVE = ANY_NUMBER + ", 1 or more"
SECONDS = "a number of seconds, 0 or more"
FLAG = "true or false"
TOPIC = "a topic's name: letters, digits, _ and /, with a letter, / or ~ in front"


class TestParameters(unittest.TestCase):
    whole = set()  # the nodes that have been run as programs of their own

    def setUp(self):
        self.started = []  # (node's name, process, sentence), of those that are not judged yet
        self.count = 0

    def tearDown(self):
        for one in self.started:
            self.judge(*one)

    def check(self, nodes, parameter, value, allowed):
        """Start nodes with a parameter of that value, and expect that each ends with a sentence
        that names both and says what is allowed."""
        shown = json.dumps(value)
        self.check_sentence(
            nodes, {parameter: value}, f"parameter ~{parameter} is {shown}, but must be {allowed}"
        )

    def check_sentence(self, nodes, parameters, sentence):
        for node in nodes:
            self.count += 1
            name = f"/node{self.count}"
            # Not by rospy, whose connection to the master a fork would share.
            master = rosgraph.Master("/test_parameters")
            master.setParam(name, parameters)
            self.addCleanup(master.deleteParam, name)
            self.started.append((name, self.start(node, "__name:=" + name[1:]), sentence))
        # Several at once take less time than one after another.
        while len(self.started) > AT_ONCE:
            self.judge(*self.started.pop(0))

    def start(self, node, argument):
        """Start a node; a Python one by itself the first time, which takes ten times as long."""
        fork = node.endswith(".py") and node in self.whole
        self.whole.add(node)
        process = (Forked if fork else Whole)(program(PACKAGE, node), argument)
        self.addCleanup(process.close)
        return process

    def judge(self, name, process, sentence):
        self.assertEqual(process.wait(), 1, f"exit code of {process}")
        texts = [line.split("]: ")[-1] for line in process.lines() if "FATAL" in line]
        self.assertEqual(texts, [f"{name}: {sentence}"], str(process))
        self.assertNotIn("Traceback", str(process))

    def test_text(self):
        self.check(PUBLISHERS, "topic", "a topic", TOPIC)
        self.check(PUBLISHERS, "topic", "", "a string that is not empty")
        self.check(SUBSCRIBERS, "topic", 5, "a string that is not empty")
        self.check(SUBSCRIBERS, "other_topic", "1st", TOPIC)

    def test_number(self):
        self.check(PUBLISHERS, "queue_size", -1, NUMBER)
        self.check(SUBSCRIBERS, "queue_size", "ten", NUMBER)
        self.check(SUBSCRIBERS, "queue_size", True, NUMBER)
        self.check(SUBSCRIBERS, "wait_for_publishers", -1, NUMBER)
        self.check(PUBLISHERS, "burst", 0, POSITIVE)
        self.check(PUBLISHERS, "first_burst", 0, POSITIVE)
        self.check(PUBLISHERS, "count", 1.5, NUMBER)
        self.check(PUBLISHERS, "start", "one", ANY_NUMBER)
        self.check(PUBLISHERS, "size", [1, 2], NUMBER)
        self.check(SUBSCRIBERS[1:], "buff_size", 0, POSITIVE)
        self.check(SUBSCRIBERS[:1], "threads", 0, POSITIVE)
        self.check(CLOCK, "begin", 0, POSITIVE)
        self.check(CLOCK, "factor", 0.5, POSITIVE)
        self.check(CLOCK, "jump", -3600, NUMBER)
        self.check(CLOCK, "jump_every", "often", POSITIVE)

    def test_seconds(self):
        self.check(PUBLISHERS, "period", -0.5, SECONDS)
        self.check(PUBLISHERS, "delay", "soon", SECONDS)
        self.check(SUBSCRIBERS, "callback_duration", True, SECONDS)

    def test_flag(self):
        self.check(PUBLISHERS, "latch", 1, FLAG)
        self.check(SUBSCRIBERS, "show_thread", "yes", FLAG)
        self.check(PUBLISHERS + SUBSCRIBERS, "show_namespaces", 1, FLAG)
        self.check(PUBLISHERS + SUBSCRIBERS, "show_type", "no", FLAG)

    def test_choice(self):
        self.check(
            PUBLISHERS[:1], "timer", "Wall", 'one of "ros", "wall", "steady", "rate", "sleep"'
        )
        # rospy has no timer on the wall's clock, but one that may outlive a jump back of the clock.
        self.check(
            PUBLISHERS[1:], "timer", "wall", 'one of "ros", "ros-reset", "steady", "rate", "sleep"'
        )
        self.check(
            SUBSCRIBERS[:1], "spinner", 2, 'one of "spin", "multi-threaded", "async", "once"'
        )
        allowed = "one of " + ", ".join(f'"{type_}"' for type_ in MESSAGE_TYPES)
        self.check(SUBSCRIBERS, "type", "std_msgs/Uint32", allowed)

    def test_values(self):
        for name in ("UInt8", "Float32", "Time", "Header", "ColorRGBA", "Int32MultiArray"):
            type_ = "std_msgs/" + name
            self.check_sentence(
                PUBLISHERS,
                {"type": type_, "values": ["1", "x 1"]},
                'parameter ~values is ["1", "x 1"], but must be a list of texts of '
                f"{type_} messages",
            )
        self.check(PUBLISHERS, "values", [1, 2], "a list of strings")
        self.check(PUBLISHERS, "values", "1", "a list of strings")

    def test_topics(self):
        allowed = "a struct of topics, each with a struct of parameters"
        self.check(PUBLISHERS + SUBSCRIBERS, "topics", ["one", "two"], allowed)
        self.check_sentence(
            PUBLISHERS + SUBSCRIBERS,
            {"topics": {"one": {}, "two": 2}},
            f"parameter ~topics is no plain value, but must be {allowed}",
        )
        # Those of each topic are checked.
        self.check_sentence(
            PUBLISHERS,
            {"count": 1, "topics": {"one": {"count": 2}, "two": {"count": -1}}},
            f"parameter ~count is -1, but must be {NUMBER}",
        )

    def test_misspelt(self):
        known = (
            "~burst, ~count, ~delay, ~first_burst, ~latch, ~on_connect, ~period, ~queue_size, "
            "~show_memory, ~show_namespaces, ~show_type, ~size, ~start, ~step, ~timer, ~topic, "
            "~topics, ~type, ~values, ~wait_for_subscribers, ~work"
        )
        self.check_sentence(
            PUBLISHERS, {"qeue_size": 1}, f"parameter ~qeue_size is not known, only {known}"
        )
        self.check_sentence(
            CLOCK,
            {"jmp": 1},
            "parameter ~jmp is not known, only ~begin, ~factor, ~jump, ~jump_every, ~period",
        )


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "parameters", TestParameters)
