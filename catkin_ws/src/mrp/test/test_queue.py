#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Queues of 10: their size, and that ten values that come all at once are all received, in order.

The node is stopped (SIGSTOP) while they are sent, so that it finds all of them on going on.
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
from mrp_testing.proves import proves
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

    @proves(
        "To create a publisher you name its topic, its type and a queue size.",
        "A publisher is created with a topic, a type and a queue size.",
        "rospy.Publisher takes the topic, the type and the queue size.",
        "The queues of these publishers hold 10 messages.",
        "A publisher needs a topic, a type and a queue size.",
    )
    def test_size_publisher_py(self):
        node = PublisherPyNode()
        self.addCleanup(node.timer.shutdown)
        self.assertEqual(node.publisher.impl.queue_size, contract.QUEUE_SIZE)

    @proves(
        "To create a subscriber you name its topic, its type, a queue size and a callback.",
        "A subscriber is created with a topic, a type, a queue size and a callback.",
    )
    def test_size_subscriber_py(self):
        node = SubscriberPyNode()
        self.assertEqual(node.subscriber.impl.queue_size, contract.QUEUE_SIZE)

    @proves(
        "With a queue of 10, each of these subscribers receives ten messages that come all at "
        "once.",
        "ROS_INFO_STREAM logs the text and msg.data.",
        "None: all ten find room in the queue.",
        "The callback gets them one after the other, in the order in which they were sent.",
        "You can publish by hand, too: a subscriber prints what anybody publishes on its topic.",
        "With a queue of 10, ten values that come together all arrive.",
    )
    def test_subscriber_cpp(self):
        self.check(contract.SUBSCRIBER_CPP)

    @proves(
        "You may call publish in any function: in another callback, in a loop, or once in main.",
        "In Python, publish also takes the value alone, and makes the message from it.",
        "So self.publisher.publish(self.counter) does what three lines do above.",
        "With a queue of 10, each of these subscribers receives ten messages that come all at "
        "once.",
        "rospy.loginfo logs the text, with msg.data in the place of %d.",
        "None: all ten find room in the queue.",
        "The callback gets them one after the other, in the order in which they were sent.",
        "You can publish by hand, too: a subscriber prints what anybody publishes on its topic.",
    )
    def test_subscriber_py(self):
        self.check(contract.SUBSCRIBER_PY)


def state_of(pid):
    """Return the state of a process as the kernel has it: "T" is stopped (see proc(5))."""
    with open(f"/proc/{pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0]


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "queue_py", TestQueue)
