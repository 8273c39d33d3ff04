#!/usr/bin/env python3
"""Sends numbers to the node, and compares each one that comes back."""

import math
import time
import unittest

import rospy
import rostest
from std_msgs.msg import Float64

DEADLINE = 20  # seconds


class TestMyPackageNode(unittest.TestCase):
    def setUp(self):
        self.received = []
        self.is_answered = False
        self.subscriber = rospy.Subscriber("output", Float64, self.output_callback)
        self.publisher = rospy.Publisher("input", Float64, queue_size=10)
        self.wait_for(self.subscriber.get_num_connections, "the node's output")
        self.wait_for(self.publisher.get_num_connections, "the node's input")
        # While the nodes connect, a number can get lost: NaN is sent until it comes back.
        self.wait_for(self.is_nan_answered, "an answer")

    def is_nan_answered(self):
        self.publisher.publish(Float64(math.nan))
        return self.is_answered

    def output_callback(self, msg):
        if math.isnan(msg.data):
            self.is_answered = True
        else:
            self.received.append(msg.data)

    def wait_for(self, condition, what):
        end = time.monotonic() + DEADLINE
        while not condition():
            self.assertLess(time.monotonic(), end, f"expected {what} within {DEADLINE} s")
            time.sleep(0.05)

    def test_each_number_comes_back_doubled(self):
        for number in (1.5, -2.0, 0.0):
            self.publisher.publish(Float64(number))
        self.wait_for(lambda: len(self.received) >= 3, "three numbers")
        self.assertEqual(self.received, [3.0, -4.0, 0.0])


if __name__ == "__main__":
    rospy.init_node("test_my_package")
    rostest.rosrun("my_package", "test_my_package", TestMyPackageNode)
