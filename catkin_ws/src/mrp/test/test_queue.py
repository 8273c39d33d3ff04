#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Queues of 10: their size, and that ten values sent at once all arrive, in order.

The node is paused (SIGSTOP) while they are sent, so it finds all ten when it runs again.
"""

import os
import signal
import sys
import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.nodes import run
from std_msgs.msg import UInt32

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "src"))
from publisher_py_node import PublisherPyNode
from subscriber_py_node import SubscriberPyNode

FIRST = 7
BURST = list(range(101, 101 + contract.QUEUE_SIZE))


class TestQueue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_queue")

    def check(self, subscriber):
        # A topic of its own, so that its connections are those of this node.
        topic = "/to_" + subscriber.name
        # Without a queue of its own, publish() returns when the value is on its way.
        publisher = rospy.Publisher(topic, UInt32, queue_size=None)

        def received():
            texts = [contract.logged_text(line) or "" for line in list(process.lines)]
            values = [contract.received_value(subscriber, text) for text in texts]
            return [value for value in values if value is not None]

        with run(subscriber, contract.TOPIC + ":=" + topic) as process:
            process.wait_for(publisher.get_num_connections, "the node is connected")
            publisher.publish(FIRST)
            process.wait_for(lambda: received() == [FIRST], "the first value is received")

            os.kill(process.pid, signal.SIGSTOP)
            process.wait_for(lambda: state_of(process.pid) == "T", "the node has stopped")
            for value in BURST:
                publisher.publish(value)
            os.kill(process.pid, signal.SIGCONT)
            process.wait_for(lambda: BURST[-1] in received(), "the last value is received")
            self.assertEqual(received(), [FIRST, *BURST])

    # What a burst cannot show, a larger queue than 10, rospy itself knows; test_queue.cpp asks
    # roscpp.

    def test_size_publisher_py(self):
        node = PublisherPyNode()
        self.addCleanup(node.timer.shutdown)
        self.assertEqual(node.publisher.impl.queue_size, contract.QUEUE_SIZE)

    def test_size_subscriber_py(self):
        node = SubscriberPyNode()
        self.assertEqual(node.subscriber.impl.queue_size, contract.QUEUE_SIZE)

    def test_subscriber_cpp(self):
        self.check(contract.SUBSCRIBER_CPP)

    def test_subscriber_py(self):
        self.check(contract.SUBSCRIBER_PY)


def state_of(pid):
    """Return the state of a process as the kernel has it: "T" is stopped (see proc(5))."""
    with open(f"/proc/{pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0]


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "queue_py", TestQueue)
