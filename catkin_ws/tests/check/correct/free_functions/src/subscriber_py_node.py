#!/usr/bin/env python
import rospy
from std_msgs.msg import UInt32

def callback(data):
    rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = " + str(data.data))

def listener():
    rospy.init_node('subscriber_py_node', anonymous=False)
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())
    rospy.Subscriber("great_topic", UInt32, callback)
    rospy.spin()

if __name__ == '__main__':
    listener()
