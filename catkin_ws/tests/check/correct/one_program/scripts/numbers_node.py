#!/usr/bin/env python3
import argparse
import sys

import rospy
from std_msgs.msg import UInt32


def publish(topic):
    publisher = rospy.Publisher(topic, UInt32, queue_size=10)
    period = rospy.Duration(rospy.get_param("~period", 0.5))
    state = {"next": 1}

    def tick(_):
        publisher.publish(state["next"])
        state["next"] = (state["next"] + 2) % (1 << 32)

    rospy.Timer(period, tick)


def show(topic):
    def show_one(message):
        rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %(value)d", {"value": message.data})

    rospy.Subscriber(topic, UInt32, callback=show_one, queue_size=10)


ROLES = {"publish": ("publisher_py_node", publish), "print": ("subscriber_py_node", show)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("role", choices=sorted(ROLES))
    role = parser.parse_args(rospy.myargv(sys.argv)[1:]).role
    name, start = ROLES[role]
    rospy.init_node(name)
    rospy.loginfo("[%s] namespace of node = %s", name.upper().replace("_", " "), rospy.get_name())
    start(rospy.get_param("~topic", "great_topic"))
    rospy.spin()


if __name__ == "__main__":
    main()
