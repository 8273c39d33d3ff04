#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Calls a service in a callback. Use it for answers that come at once: while you wait for a slow
one, all messages of the publisher wait, too."""

import rospy
from roscpp.srv import Empty, EmptyResponse
from std_msgs.msg import UInt32


class ServiceInCallback:
    def __init__(self):
        # The node calls its own service. rospy answers it in another thread.
        self.service = rospy.Service("answer", Empty, self.service_callback)
        self.client = rospy.ServiceProxy("answer", Empty)
        self.subscriber = rospy.Subscriber(
            "number", UInt32, self.subscriber_callback, queue_size=10
        )

    def service_callback(self, request):
        return EmptyResponse()

    def subscriber_callback(self, msg):
        rospy.loginfo("%s asks about %d", rospy.get_name(), msg.data)
        self.client()
        rospy.loginfo("%s has the answer about %d", rospy.get_name(), msg.data)


def main():
    rospy.init_node("service_in_callback")
    node = ServiceInCallback()
    rospy.spin()


if __name__ == "__main__":
    main()
