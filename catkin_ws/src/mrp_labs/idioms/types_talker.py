#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes three types of message. To see which fields a type has, ask rosmsg show."""

import rospy
from std_msgs.msg import Int8, Int32MultiArray, String


def main():
    rospy.init_node("types_talker")
    small = rospy.Publisher("small", Int8, queue_size=1, latch=True)
    text = rospy.Publisher("text", String, queue_size=1, latch=True)
    numbers = rospy.Publisher("numbers", Int32MultiArray, queue_size=1, latch=True)

    small_msg = Int8()
    small_msg.data = -128
    small.publish(small_msg)

    text_msg = String()
    text_msg.data = "Grüße, Welt: 世界 🤖"
    text.publish(text_msg)

    numbers_msg = Int32MultiArray()
    numbers_msg.data = [1, 2, 3]
    numbers.publish(numbers_msg)
    rospy.spin()


if __name__ == "__main__":
    main()
