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

        # After 2^32-1 comes 1: Python's numbers do not wrap round by themselves,
        # and a UInt32 cannot hold a larger one.
        self.counter = (self.counter + 2) % 2**32


def main():
    rospy.init_node("publisher_py_node")

    # The node's name is also its own namespace: the group's, and then the node's name.
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())

    node = PublisherPyNode()
    rospy.spin()


if __name__ == "__main__":
    main()
