#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use a global name for what all robots share, such as a map. What each robot has for itself needs
a relative one."""

import rospy
from std_msgs.msg import UInt32


def subscriber_callback(msg):
    rospy.loginfo("received %d", msg.data)


def main():
    rospy.init_node("name_global")

    # Started in any namespace, the node subscribes to /great_topic.
    subscriber = rospy.Subscriber("/great_topic", UInt32, subscriber_callback, queue_size=10)
    rospy.loginfo("subscribes to %s", subscriber.resolved_name)
    rospy.spin()


if __name__ == "__main__":
    main()
