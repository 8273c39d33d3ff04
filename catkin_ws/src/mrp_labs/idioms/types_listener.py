#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Prints what types_talker publishes: each type needs a callback that knows its fields."""

import rospy
from std_msgs.msg import Int8, Int32MultiArray, String


def small_callback(msg):
    rospy.loginfo("small: %d", msg.data)


def text_callback(msg):
    rospy.loginfo('text: "%s"', msg.data)


def numbers_callback(msg):
    rospy.loginfo("numbers: %d, the last is %d", len(msg.data), msg.data[-1])


def main():
    rospy.init_node("types_listener")
    small = rospy.Subscriber("small", Int8, small_callback, queue_size=10)
    text = rospy.Subscriber("text", String, text_callback, queue_size=10)
    numbers = rospy.Subscriber("numbers", Int32MultiArray, numbers_callback, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
