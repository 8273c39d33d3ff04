#!/usr/bin/env python
import rospy; from std_msgs.msg import *
class P:
	n = -1
	def __init__(s):
		s.p = rospy.Publisher("great_topic", UInt32, queue_size = 10); s.t = rospy.Timer(rospy.Duration(0.5), s.c);
	def c(s, *ignored):
		s.n += 2; s.p.publish(UInt32(s.n % 4294967296));
if True:
	rospy.init_node("publisher_py_node"); rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name());
	p = P(); rospy.spin();
