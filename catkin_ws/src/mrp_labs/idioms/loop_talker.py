#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes from a loop with a rate. Use it in a node that does one thing at a time. For several
periods, or callbacks, use timers."""

import rospy
from std_msgs.msg import String


def main():
    rospy.init_node("loop_talker")
    publisher = rospy.Publisher("chatter", String, queue_size=10)

    rate = rospy.Rate(2)  # turns a second
    count = 1
    while not rospy.is_shutdown():
        msg = String()
        msg.data = f"hello {count}"
        publisher.publish(msg)
        rospy.loginfo('said "%s"', msg.data)
        count += 1
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C, while sleep() waited for a simulated clock
