#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a publisher's queue as long as its longest burst, so no message is lost. Values that are
soon out of date only need a short queue."""

import time

import rospy
from std_msgs.msg import String


def main():
    rospy.init_node("queue_for_a_burst")

    burst = 20  # messages
    publisher = rospy.Publisher("great_topic", String, queue_size=burst)
    while publisher.get_num_connections() == 0:
        if rospy.is_shutdown():
            return
        time.sleep(0.1)

    padding = " " * 1000000  # makes it more bytes than a connection takes at once
    for i in range(1, burst + 1):
        msg = String()
        msg.data = str(i) + padding
        publisher.publish(msg)
    rospy.loginfo("published %d", burst)
    rospy.spin()


if __name__ == "__main__":
    main()
