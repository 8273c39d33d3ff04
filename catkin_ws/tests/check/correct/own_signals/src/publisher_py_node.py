#!/usr/bin/env python3
import atexit
import signal
import sys

import numpy
import rospy
from std_msgs.msg import UInt32

STEP = numpy.uint32(2)


class PublisherPyNode:
    def __init__(self):
        self.number = numpy.array([1], dtype=numpy.uint32)
        self.publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.publish)

    def publish(self, event):
        self.publisher.publish(int(self.number[0]))
        self.number += STEP

    def stop(self):
        self.timer.shutdown()


def interrupted(number, frame):
    rospy.signal_shutdown("Ctrl-C")


if __name__ == "__main__":
    rospy.init_node("publisher_py_node", disable_signals=True)
    signal.signal(signal.SIGINT, interrupted)
    atexit.register(rospy.logdebug, "the end")
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())
    node = PublisherPyNode()
    rospy.on_shutdown(node.stop)
    rospy.spin()
    sys.exit(0)
