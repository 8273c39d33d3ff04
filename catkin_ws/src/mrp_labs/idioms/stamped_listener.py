#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Says how long each message was on its way. On two machines, that's only right if their clocks
agree."""

import rospy
from mrp_labs.msg import Count


def subscriber_callback(msg):
    latency = (rospy.Time.now() - msg.header.stamp).to_sec() * 1000  # ms
    rospy.loginfo("%d, counted in %s, sent %.1f ms ago", msg.counter, msg.language, latency)


def main():
    rospy.init_node("stamped_listener")
    subscriber = rospy.Subscriber("count", Count, subscriber_callback, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
