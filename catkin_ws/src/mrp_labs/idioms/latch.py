#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Latches a publisher. Do this for a message that rarely changes and that late subscribers need,
such as a map. Don't do it for a stream of values."""

import rospy
from std_msgs.msg import UInt32


def main():
    rospy.init_node("latch")

    # It keeps the last message, and sends it to each subscriber that connects later.
    publisher = rospy.Publisher("great_topic", UInt32, queue_size=1, latch=True)

    msg = UInt32()
    msg.data = 42
    publisher.publish(msg)
    rospy.loginfo("published %d", msg.data)
    rospy.spin()


if __name__ == "__main__":
    main()
