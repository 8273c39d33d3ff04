#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes from a subscriber's callback, without a timer. Use it to answer a message. To publish
at a rate of your own, use a timer."""

import rospy
from std_msgs.msg import UInt32


class PublishAnywhere:
    def __init__(self):
        # The publisher comes first: the callback needs it from the first message on.
        self.publisher = rospy.Publisher("doubled", UInt32, queue_size=10)
        self.subscriber = rospy.Subscriber(
            "number", UInt32, self.subscriber_callback, queue_size=10
        )

    def subscriber_callback(self, msg):
        # The short form: rospy makes the message from the value.
        self.publisher.publish(2 * msg.data)


def main():
    rospy.init_node("publish_anywhere")
    node = PublishAnywhere()
    rospy.spin()


if __name__ == "__main__":
    main()
