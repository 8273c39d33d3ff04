#!/usr/bin/env python3
import rospy
from std_msgs.msg import UInt32

rospy.init_node('subscriber_py_node')
rospy.loginfo('[SUBSCRIBER PY NODE] namespace of node = %s', rospy.get_name())
show = lambda msg: rospy.loginfo('[SUBSCRIBER PY NODE] received message with data = %s', msg.data)
rospy.Subscriber('great_topic', UInt32, show, queue_size=10)
rospy.spin()
