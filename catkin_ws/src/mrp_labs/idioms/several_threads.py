#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Use several threads where one callback must not hold up another, and put a lock around what the
callbacks share."""

import threading

import rospy
from std_msgs.msg import UInt32


class SeveralThreads:
    def __init__(self):
        self.lock = threading.Lock()
        self.total = 0
        self.first = rospy.Subscriber("first", UInt32, self.subscriber_callback, queue_size=10)
        self.second = rospy.Subscriber("second", UInt32, self.subscriber_callback, queue_size=10)

    # rospy calls it in the thread of each publisher's connection: you don't have to do a thing.
    def subscriber_callback(self, msg):
        with self.lock:
            self.total += msg.data
            rospy.loginfo("total %d in thread %d", self.total, threading.get_ident())


def main():
    rospy.init_node("several_threads")
    node = SeveralThreads()
    rospy.spin()


if __name__ == "__main__":
    main()
