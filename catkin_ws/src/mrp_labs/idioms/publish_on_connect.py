#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes to each new subscriber separately. Use it if each gets a message of its own. If all get
the same one, latch it."""

import rospy
from std_msgs.msg import UInt32


class PublishOnConnect(rospy.SubscribeListener):
    def __init__(self):
        self.subscribers = 0
        self.publisher = rospy.Publisher("great_topic", UInt32, self, queue_size=10)

    # peer_publish sends to the new subscriber only.
    def peer_subscribe(self, topic_name, topic_publish, peer_publish):
        self.subscribers += 1
        msg = UInt32()
        msg.data = self.subscribers
        peer_publish(msg)


def main():
    rospy.init_node("publish_on_connect")
    node = PublishOnConnect()
    rospy.spin()


if __name__ == "__main__":
    main()
