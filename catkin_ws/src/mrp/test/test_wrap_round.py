#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the Python publisher up to 2^32-1 and beyond: which numbers come next?"""

import os
import sys
import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.waiting import wait_until
from std_msgs.msg import UInt32

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "src"))
from publisher_py_node import PublisherPyNode

LAST = 2**32 - 1  # the largest odd number that a UInt32 holds


class TestWrapRound(unittest.TestCase):
    def test_publisher_py(self):
        rospy.init_node("test_wrap_round")
        values = []
        subscriber = rospy.Subscriber(contract.TOPIC, UInt32, lambda msg: values.append(msg.data))
        node = PublisherPyNode()
        node.timer.shutdown()  # from here on the test alone says when to publish
        node.timer.join()
        wait_until(
            lambda: subscriber.get_num_connections() and node.publisher.get_num_connections(),
            "the test's subscriber is connected",
        )
        del values[:]
        node.counter = LAST
        for _ in range(3):
            node.timer_callback(None)
        wait_until(lambda: len(values) >= 3, lambda: f"three values: {values}")
        self.assertEqual(values, [LAST, 1, 3])


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "wrap_round_py", TestWrapRound)
