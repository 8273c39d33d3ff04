#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stops each node: its exit code, what it prints, and whether the master still lists it."""

import pathlib
import signal
import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.nodes import program, run
from mrp_testing.process import LIVE, Process
from std_msgs.msg import UInt32

SLOW_END = str(pathlib.Path(__file__).with_name("slow_end.py"))


class TestStop(unittest.TestCase):
    maxDiff = None  # a traceback is told whole

    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_stop")
        cls.publisher = rospy.Publisher(contract.TOPIC, UInt32, queue_size=10)

    def stop(self, node, signal_number, start=run):
        """Stop a node in the midst of its work; return its exit code, stderr and registrations.

        start: starts the node and returns its Process
        """
        values = []
        subscriber = rospy.Subscriber(contract.TOPIC, UInt32, values.append)
        self.addCleanup(subscriber.unregister)
        with start(node) as process:
            if node in contract.PUBLISHERS:
                process.wait_for(lambda: values, "a value from " + node.name)
            else:
                # Publish until the node logs it: the first ones come before it is connected.
                def logged():
                    self.publisher.publish(7)
                    line = contract.RECEIVED_LINE[node].format(7)
                    return line in map(contract.logged_text, list(process.lines))

                process.wait_for(logged, node.name + " logs a value")
            code = process.stop(signal_number)
        name = "/" + node.name
        return code, process.errors, name in Graph().nodes

    def check_sigint(self, node):
        self.assertEqual(self.stop(node, signal.SIGINT), (0, [], False))

    def test_sigint_publisher_cpp(self):
        self.check_sigint(contract.PUBLISHER_CPP)

    def test_sigint_publisher_py(self):
        self.check_sigint(contract.PUBLISHER_PY)

    def test_sigint_subscriber_cpp(self):
        self.check_sigint(contract.SUBSCRIBER_CPP)

    def test_sigint_subscriber_py(self):
        self.check_sigint(contract.SUBSCRIBER_PY)

    def test_sigint_while_the_timer_of_publisher_py_fires(self):
        def start(node):
            node_path = program(contract.PACKAGE, node.executable)
            return Process(SLOW_END, node_path, extra_env=LIVE)

        stopped = self.stop(contract.PUBLISHER_PY, signal.SIGINT, start)
        self.assertEqual(stopped, (0, [], False))

    # rospy ends on SIGTERM as on SIGINT. roscpp has no handler for it: the signal kills the node,
    # which stays registered at the master.

    def check_sigterm_cpp(self, node):
        self.assertEqual(self.stop(node, signal.SIGTERM), (-signal.SIGTERM, [], True))

    def check_sigterm_py(self, node):
        self.assertEqual(self.stop(node, signal.SIGTERM), (0, [], False))

    def test_sigterm_publisher_cpp(self):
        self.check_sigterm_cpp(contract.PUBLISHER_CPP)

    def test_sigterm_publisher_py(self):
        self.check_sigterm_py(contract.PUBLISHER_PY)

    def test_sigterm_subscriber_cpp(self):
        self.check_sigterm_cpp(contract.SUBSCRIBER_CPP)

    def test_sigterm_subscriber_py(self):
        self.check_sigterm_py(contract.SUBSCRIBER_PY)


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "stop", TestStop)
