#!/usr/bin/env python
import rospy
from std_msgs.msg import UInt32 as Number

NODE_NAME = "subscriber_py_node"
TAG = "[SUBSCRIBER PY NODE]"


def log(text, *values):
    rospy.loginfo(TAG + " " + text, *values)


def main():
    rospy.init_node(NODE_NAME)
    log("namespace of node = %s", rospy.get_name())
    subscriber = rospy.Subscriber("great_topic", Number, lambda m: log("received message with data = %d", m.data), queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
