#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes the odd numbers 1, 3, 5, ... on "great_topic", one every half second."""

import rospy
from std_msgs.msg import UInt32


class PublisherPyNode:
    def __init__(self):
        self.counter = 1

        # A relative name: the group's namespace goes in front of it, as in /mrp/great_topic.
        self.publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)

        self.timer = rospy.Timer(rospy.Duration(0.5), self.timer_callback)

        # The timer is a thread: at Ctrl-C it has to end before the publisher does.
        rospy.on_shutdown(self.timer.shutdown)

    def timer_callback(self, event):
        msg = UInt32()
        msg.data = self.counter
        self.publisher.publish(msg)

        # A UInt32 can't go past 2^32-1, and Python's own numbers never wrap around,
        # so start over at 1.
        self.counter = (self.counter + 2) % 2**32


def main():
    rospy.init_node("publisher_py_node")

    # The full name, such as /mrp/publisher_py_node; it's also the node's private namespace.
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())

    node = PublisherPyNode()
    rospy.spin()


if __name__ == "__main__":
    main()
