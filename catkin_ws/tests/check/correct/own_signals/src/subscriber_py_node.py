#!/usr/bin/env python3
import sys

import rospy
from std_msgs.msg import UInt32


def main(arguments):
    rospy.init_node("subscriber_py_node", disable_signals=True)
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())
    subscriber = rospy.Subscriber(
        "great_topic",
        UInt32,
        lambda message: rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = {0}".format(message.data)),
        queue_size=10,
    )
    try:
        while not rospy.is_shutdown():
            rospy.rostime.wallsleep(0.1)
    except KeyboardInterrupt:
        subscriber.unregister()
        rospy.signal_shutdown("Ctrl-C")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
