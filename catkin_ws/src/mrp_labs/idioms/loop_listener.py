#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Listens to loop_talker. A node that only reacts needs no loop of its own: use rospy.spin."""

import rospy
from std_msgs.msg import String


def subscriber_callback(msg):
    rospy.loginfo('heard "%s"', msg.data)


def main():
    rospy.init_node("loop_listener")
    subscriber = rospy.Subscriber("chatter", String, subscriber_callback, queue_size=10)

    # rospy calls the callback in another thread. This only waits for Ctrl-C.
    rospy.spin()


if __name__ == "__main__":
    main()
