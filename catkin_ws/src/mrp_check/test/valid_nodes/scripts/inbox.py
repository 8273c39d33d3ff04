#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Wait for what a callback puts into a queue, a moment at a time."""

import queue

import rospy
from std_msgs.msg import String


def main():
    rospy.init_node("inbox")
    inbox = queue.Queue()
    rospy.Subscriber("pattern", String, inbox.put)
    while not rospy.is_shutdown():
        try:
            message = inbox.get(timeout=0.2)
        except queue.Empty:
            continue
        rospy.loginfo_throttle(5, "heard %s", message.data)


if __name__ == "__main__":
    main()
