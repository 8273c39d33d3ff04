#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use a subscriber's queue of 1 if only the newest value counts, such as a sensor's. If every value
counts, use a longer one."""

import time

import rospy
from std_msgs.msg import UInt32


def subscriber_callback(msg):
    rospy.loginfo("received %d", msg.data)
    time.sleep(1.0)  # stands for work that takes longer than the publisher's period


def main():
    rospy.init_node("queue_of_one")

    # While the callback is busy, each new message replaces the one before it.
    subscriber = rospy.Subscriber("great_topic", UInt32, subscriber_callback, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
