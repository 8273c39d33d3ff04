#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Changes a message after it was published. Don't: a latched publisher sends it again."""

import rospy
from std_msgs.msg import UInt32


def main():
    rospy.init_node("changed_message")
    publisher = rospy.Publisher("great_topic", UInt32, queue_size=10, latch=True)

    msg = UInt32()
    msg.data = 1
    publisher.publish(msg)
    msg.data = 2  # for the next message; but late subscribers get it already
    rospy.loginfo("published 1, and changed the message to %d", msg.data)
    rospy.spin()


if __name__ == "__main__":
    main()
