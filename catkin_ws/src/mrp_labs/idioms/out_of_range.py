#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes a value that doesn't fit. Don't: check a value before you publish it. After the
exception, the publisher's Python subscribers stay deaf."""

import itertools

import rospy
from std_msgs.msg import UInt32


def main():
    rospy.init_node("out_of_range")
    publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)
    rate = rospy.Rate(2)
    for value in itertools.cycle([1, 2, -1, 4, 5]):
        rate.sleep()
        if rospy.is_shutdown():
            return
        msg = UInt32()
        msg.data = value
        try:
            publisher.publish(msg)
        except rospy.ROSSerializationException as error:
            rospy.logerr("%s can't publish %d: %s", rospy.get_name(), value, error)


if __name__ == "__main__":
    main()
