#!/usr/bin/env python3
# -*- coding: utf-8 -*-

import rospy
from std_msgs.msg import UInt32

class Subscriber:

    def __init__(self):
        topic = rospy.get_namespace().rstrip('/') + '/great_topic'
        self.sub = rospy.Subscriber(topic, UInt32, self.callback, queue_size=10)

    def callback(self, msg):
        rospy.loginfo('[SUBSCRIBER PY NODE] received message with data = %d' % msg.data)

rospy.init_node('subscriber_py_node')
rospy.loginfo('[SUBSCRIBER PY NODE] namespace of node = %s' % rospy.get_name())
subscriber = Subscriber()
while not rospy.is_shutdown():
    rospy.rostime.wallsleep(0.5)
