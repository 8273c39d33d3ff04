#!/usr/bin/env python3
import ctypes
import functools

import rospy
import std_msgs.msg


def publish(publisher, number, event=None):
    publisher.publish(std_msgs.msg.UInt32(data=number.value))
    number.value += 2


if __name__ == "__main__":
    rospy.init_node("publisher_py_node")
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = {}".format(rospy.get_name()))
    publisher = rospy.Publisher(name="great_topic", data_class=std_msgs.msg.UInt32, queue_size=10)
    number = ctypes.c_uint32(1)
    timer = rospy.Timer(period=rospy.Duration.from_sec(0.5), callback=functools.partial(publish, publisher, number))
    rospy.spin()
