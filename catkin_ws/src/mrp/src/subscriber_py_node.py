#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Prints every number that arrives on "great_topic", no matter who published it."""

import rospy
from std_msgs.msg import UInt32


class SubscriberPyNode:
    def __init__(self):
        # A relative name: the group's namespace goes in front of it, as in /mrp/great_topic.
        # In Python each publisher's connection has a queue of its own.
        self.subscriber = rospy.Subscriber(
            "great_topic", UInt32, self.subscriber_callback, queue_size=10
        )

    def subscriber_callback(self, msg):
        rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %d", msg.data)


def main():
    rospy.init_node("subscriber_py_node")

    # The full name, such as /mrp/subscriber_py_node; it's also the node's private namespace.
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())

    node = SubscriberPyNode()
    rospy.spin()


if __name__ == "__main__":
    main()
