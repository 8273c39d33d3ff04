#!/usr/bin/env python3
import rospy
from std_msgs.msg import UInt32


class Ears(object):
    def __call__(self, message):
        rospy.loginfo(f"[SUBSCRIBER PY NODE] received message with data = {message.data}")


if __name__ == "__main__":
    rospy.init_node("subscriber_py_node")
    rospy.loginfo(f"[SUBSCRIBER PY NODE] namespace of node = {rospy.get_name()}")
    rospy.Subscriber("great_topic", UInt32, Ears(), None, 10)
    rospy.spin()
