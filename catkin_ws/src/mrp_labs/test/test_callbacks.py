#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs callbacks that share a value, wait for each other or call themselves."""

import contextlib
import re
import unittest

import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until
from std_msgs.msg import String, UInt32

MANY = 1000  # messages, of which a node has been sent one


@contextlib.contextmanager
def values_on(topic):
    """Yield a list, to which each number is added that somebody publishes on a topic."""
    values = []
    subscriber = rospy.Subscriber(topic, UInt32, lambda msg: values.append(msg.data))
    try:
        yield values
    finally:
        subscriber.unregister()


class TestCallbacks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_callbacks")

    def test_shared_without_lock(self):
        with Lab("shared_without_lock.launch", extra_env=LIVE) as lab:

            def totals(pattern):
                found = (re.fullmatch(pattern, text) for text in log_line.texts(lab.lines))
                return [int(match[1]) for match in found if match]

            def unlocked():
                return totals(r"without a lock: total (\d+)")

            def locked():
                return totals(r"total (\d+) in thread \d+")

            # Each line is of one message, with the number 1.
            lab.wait_for(lambda: unlocked() and unlocked()[-1] < len(unlocked()), "a value is lost")
            # Two callbacks have read the same total, and so logged the same.
            self.assertLess(len(set(unlocked())), len(unlocked()))
            lab.wait_for(lambda: len(locked()) >= len(unlocked()), "both have counted")
            self.assertEqual(locked(), list(range(1, len(locked()) + 1)))

    def test_callback_that_answers_itself(self):
        error = "rospy.exceptions.ROSSerializationException: field data exceeds specified width"
        with values_on("/feedback_cpp/number") as cpp, values_on("/feedback_py/number") as py, Lab(
            "feedback.launch", extra_env=LIVE, traceback=True
        ) as lab:
            # In Python it ends with the first number that is too large.
            lab.wait_for(lambda: error in "\n".join(lab.errors), error)
            self.assertIn("bad callback: <bound method PublishAnywhere", "\n".join(lab.errors))
            wait_until(lambda: 2**31 in py, lambda: f"the largest number, not only {py}")
            self.assertLessEqual(set(py), {2**i for i in range(32)})
            # In C++ it goes on for ever, with zeros: no number is too large.
            wait_until(lambda: cpp.count(0) > MANY, lambda: f"zeros, not only {len(cpp)} values")
            in_cpp = re.compile(r"\[[ A-Z]+\] \[\d+\.\d{9}\]: ")
            self.assertEqual([line for line in list(lab.lines) if in_cpp.match(line)], [])
            with Process("rosnode", "info", "/feedback_cpp/publish_anywhere") as info:
                self.assertEqual(info.wait(), 0)
            for heading in ("Publications", "Subscriptions"):
                topics = rf"^{heading}: *\n( \* .*\n)*? \* /feedback_cpp/number \[std_msgs/UInt32\]"
                self.assertRegex("\n".join(info.lines), re.compile(topics, re.MULTILINE))

    def test_changed_message(self):
        with Process(program(PACKAGE, "changed_message.py"), extra_env=LIVE) as node:
            node.wait_for(lambda: log_line.texts(node.lines), "it has published 1")
            with values_on("/great_topic") as values:
                wait_until(lambda: values == [2], lambda: f"2, which it never published: {values}")

    def test_what_publish_takes(self):
        """Calls publish in its short forms, and in wrong ones: what does rospy say?"""
        number = rospy.Publisher("/number", UInt32, queue_size=10)
        text = rospy.Publisher("/text", String, queue_size=10)
        self.addCleanup(number.unregister)
        self.addCleanup(text.unregister)
        heard = []
        subscriber = rospy.Subscriber("/text", String, lambda msg: heard.append(msg.data))
        self.addCleanup(subscriber.unregister)
        with values_on("/number") as values:
            wait_until(number.get_num_connections, "it is connected")
            wait_until(text.get_num_connections, "it is connected")
            for publisher, right in (
                (number, 3),
                (number, UInt32(3)),
                (text, "a"),
                (text, String("a")),
            ):
                publisher.publish(right)
            wait_until(lambda: values == [3, 3] and heard == ["a", "a"], f"{values}, {heard}")
            for publisher, wrong, error in (
                (number, ("a",), "field data must be unsigned integer type"),
                (text, (3,), "field data must be of type bytes or an ascii string"),
                (text, ("a", "b"), "Invalid number of arguments, args should be ['data']"),
                (number, (String("a"),), "expected [uint32] but got [std_msgs/String]"),
            ):
                with self.assertRaises((rospy.ROSSerializationException, TypeError)) as raised:
                    publisher.publish(*wrong)
                self.assertIn(error, str(raised.exception))


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "callbacks", TestCallbacks)
