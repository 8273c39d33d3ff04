#!/usr/bin/env python3
import rospy
from std_msgs.msg import UInt32

rospy.init_node('publisher_py_node')
rospy.loginfo('[PUBLISHER PY NODE] namespace of node = %s', rospy.get_name())
pub = rospy.Publisher('great_topic', UInt32, queue_size=10)
number = UInt32(1)


def tick(event):
    pub.publish(number)
    number.data = (number.data + 2) & 0xFFFFFFFF


rospy.Timer(rospy.Duration(0.5), lambda event: tick(event))
rospy.spin()
