#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Waits for one message at a time. Use it for a topic that's latched, or that never falls silent.
If every message counts, use a subscriber."""

import rospy
from std_msgs.msg import UInt32


def main():
    rospy.init_node("wait_for_message")
    rate = rospy.Rate(1)  # turns a second
    while not rospy.is_shutdown():
        # It subscribes, waits and unsubscribes. What comes between two turns is lost.
        msg = rospy.wait_for_message("great_topic", UInt32)
        rospy.loginfo("received %d", msg.data)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C, while it waited
