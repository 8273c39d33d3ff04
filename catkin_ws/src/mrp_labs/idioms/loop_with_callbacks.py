#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Combines a loop with a subscriber, for when each turn needs the newest value. If you need every
value, do the work in the callback."""

import rospy
from std_msgs.msg import UInt32


class LoopWithCallbacks:
    def __init__(self):
        self.newest = UInt32()
        self.publisher = rospy.Publisher("newest", UInt32, queue_size=10)
        self.subscriber = rospy.Subscriber(
            "number", UInt32, self.subscriber_callback, queue_size=10
        )

    def run(self):
        rate = rospy.Rate(10)  # turns a second
        while not rospy.is_shutdown():
            # There is no spinOnce: rospy calls the callback in another thread, at any moment.
            self.publisher.publish(self.newest)
            rate.sleep()

    def subscriber_callback(self, msg):
        self.newest = msg


def main():
    rospy.init_node("loop_with_callbacks")
    LoopWithCallbacks().run()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C, while sleep() waited for a simulated clock
