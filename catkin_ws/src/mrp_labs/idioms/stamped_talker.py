#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes a message type of its own, with a header that says when. Set the stamp to the moment
that the message is about: rospy leaves it at 0."""

import rospy
from mrp_labs.msg import Count


class StampedTalker:
    def __init__(self):
        self.counter = 0
        self.publisher = rospy.Publisher("count", Count, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.timer_callback)

    def timer_callback(self, event):
        self.counter += 1
        msg = Count()
        msg.header.stamp = rospy.Time.now()
        msg.counter = self.counter
        msg.language = "Python"
        self.publisher.publish(msg)


def main():
    rospy.init_node("stamped_talker")
    node = StampedTalker()
    rospy.spin()


if __name__ == "__main__":
    main()
