#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Callbacks that share a total without a lock: values get lost. several_threads has the lock."""

import rospy
from std_msgs.msg import UInt32


class SharedWithoutLock:
    def __init__(self):
        self.total = 0
        self.first = rospy.Subscriber("first", UInt32, self.subscriber_callback, queue_size=10)
        self.second = rospy.Subscriber("second", UInt32, self.subscriber_callback, queue_size=10)

    # Two threads may be in here at once.
    def subscriber_callback(self, msg):
        total = self.total
        rospy.sleep(0.1)  # work; meanwhile the other thread reads the same total
        self.total = total + msg.data
        rospy.loginfo("without a lock: total %d", self.total)


def main():
    rospy.init_node("shared_without_lock")
    node = SharedWithoutLock()
    rospy.spin()


if __name__ == "__main__":
    main()
