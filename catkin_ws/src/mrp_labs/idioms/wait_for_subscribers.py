#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Waits for its subscribers before the first message. Use it if no message may be lost and you know
how many subscribers there are: it waits forever."""

import time

import rospy
from std_msgs.msg import UInt32


def main():
    rospy.init_node("wait_for_subscribers")
    publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)

    expected = 2  # subscribers
    while publisher.get_num_connections() < expected:
        if rospy.is_shutdown():
            return
        time.sleep(0.1)  # rospy.sleep would wait for a simulated clock

    msg = UInt32()
    for msg.data in (1, 2, 3):
        publisher.publish(msg)
    rospy.spin()


if __name__ == "__main__":
    main()
