#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use a private name for what belongs to one node only. A topic that nodes share needs a relative
name."""

import rospy
from std_msgs.msg import UInt32


def subscriber_callback(msg):
    rospy.loginfo("received %d", msg.data)


def main():
    rospy.init_node("name_private")

    # Started in the namespace /robot1, the node subscribes to /robot1/name_private/great_topic.
    subscriber = rospy.Subscriber("~great_topic", UInt32, subscriber_callback, queue_size=10)
    rospy.loginfo("subscribes to %s", subscriber.resolved_name)
    rospy.spin()


if __name__ == "__main__":
    main()
