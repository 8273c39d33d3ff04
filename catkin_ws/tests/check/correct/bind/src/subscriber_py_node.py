#!/usr/bin/env python3
import rospy
import std_msgs.msg as messages


def received(message, text):
    rospy.loginfo(text.format(message.data))


if __name__ == "__main__":
    rospy.init_node(name="subscriber_py_node")
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = {}".format(rospy.get_name()))
    rospy.Subscriber(
        name="great_topic",
        data_class=messages.UInt32,
        callback=received,
        callback_args="[SUBSCRIBER PY NODE] received message with data = {}",
        queue_size=None,
    )
    rospy.spin()
