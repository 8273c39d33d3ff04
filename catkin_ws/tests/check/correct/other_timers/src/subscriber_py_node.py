#!/usr/bin/env python
import queue

import rospy
from std_msgs.msg import UInt32

waiting = queue.Queue()


def main():
    rospy.init_node("subscriber_py_node")
    rospy.loginfo("[SUBSCRIBER PY NODE] namespace of node = " + rospy.get_name())
    subscriber = rospy.Subscriber("great_topic", UInt32, waiting.put, queue_size=20)
    while not rospy.is_shutdown():
        try:
            msg = waiting.get(timeout=0.1)
        except queue.Empty:
            continue
        rospy.loginfo("[SUBSCRIBER PY NODE] received message with data = %d", msg.data)


if __name__ == "__main__":
    main()
