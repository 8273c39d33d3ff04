#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use an anonymous name for a tool that you run several times at once. A node with parameters, or
one that others ask for by name, needs a fixed one."""

import rospy
from std_msgs.msg import UInt32


def subscriber_callback(msg):
    rospy.loginfo("received %d", msg.data)


def main():
    rospy.init_node("anonymous_name", anonymous=True)
    rospy.loginfo("my name is %s, my rate is %d", rospy.get_name(), rospy.get_param("~rate", 1))

    subscriber = rospy.Subscriber("great_topic", UInt32, subscriber_callback, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
