#!/usr/bin/env python
# -*- coding: utf-8 -*-
"""Affiche chaque numéro reçu."""

import rospy
from std_msgs.msg import UInt32


def reçu(message):
    rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %d", message.data)


def principal():
    rospy.init_node("subscriber_py_node")
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())
    abonné = rospy.Subscriber("great_topic", UInt32, reçu, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    principal()
