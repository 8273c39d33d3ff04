#!/usr/bin/env python
import threading

import rospy
from std_msgs.msg import UInt32


class SubscriberPyNode:
    def __init__(self):
        self.lock = threading.Lock()
        self.count = 0
        self.subscriber = rospy.Subscriber("great_topic", UInt32, self.heard, queue_size=10)
        threading.Thread(target=self.report, daemon=True).start()

    def heard(self, msg):
        with self.lock:
            self.count += 1
            rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %d", msg.data)

    def report(self):
        while True:
            rospy.rostime.wallsleep(10)
            with self.lock:
                rospy.logdebug("%d so far", self.count)


if __name__ == "__main__":
    rospy.init_node("subscriber_py_node")
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())
    node = SubscriberPyNode()
    rospy.spin()
