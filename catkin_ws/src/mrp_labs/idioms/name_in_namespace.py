#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use names in a namespace below the node's for a part with several topics. To group nodes, use a
group in the launch file."""

import rospy
from std_msgs.msg import UInt32


def subscriber_callback(msg):
    rospy.loginfo("received %d", msg.data)


def main():
    rospy.init_node("name_in_namespace")

    # Started in the namespace /robot1, the node subscribes to /robot1/arm/great_topic.
    subscriber = rospy.Subscriber("arm/great_topic", UInt32, subscriber_callback, queue_size=10)
    rospy.loginfo("subscribes to %s", subscriber.resolved_name)
    rospy.spin()


if __name__ == "__main__":
    main()
