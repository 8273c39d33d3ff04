#!/usr/bin/env python
# -*- coding: utf-8 -*-
# SPDX-License-Identifier: CC-BY-4.0
# By Paul N. Beuchat, 2023: see ../README.md. Printed here with its mistakes.

import rospy
from std_msgs.msg import UInt32

class PublisherPyNode:

    def __init__(self):
        # Initialise a publisher
        self.m_publisher = rospy.Publisher(this_nodes_namespace + "/great_topic", UInt32, queue_size=10, latch=False)
        # Initialise a counter
        self.counter = 1
        # Initialise a timer
        timer_delta_t_in_seconds = 0.5;
        rospy.Timer(rospy.Duration(timer_delta_t_in_seconds), self.timerCallback)

    # Implement the timer callback
    def timerCallback(self, event):
        self.counter += 2
        # Publish a message
        self.m_publisher.publish(self.counter)

if __name__ == '__main__':
    # Initialise the node
    rospy.init_node("publisher_py_node")
    # Display the namespace of the node handle
    rospy.loginfo("PUBLISHER PY NODE] namespace of node = " + rospy.get_namespace())
    # Put the namespace into a global variable for this script
    global this_nodes_namespace = rospy.get_namespace()
    # Start an instance of the class
    publisher_py_node = PublisherPyNode()
    # Spin as a single-threaded node
    rospy.spin()
