#!/usr/bin/env python
"""Odd numbers. Names are constants, as a careful student has them."""
import rospy
from std_msgs.msg import UInt32 as Number

NODE_NAME = "publisher_py_node"
TOPIC = "great_topic"
QUEUE_SIZE = 10
PERIOD = 0.5  # s
TAG = "[" + NODE_NAME.upper().replace("_", " ") + "]"


class OddNumbers:
    def __init__(self, topic=TOPIC):
        self._next = 1
        self._publisher = rospy.Publisher(topic, Number, queue_size=QUEUE_SIZE)
        self._timer = rospy.Timer(rospy.Duration.from_sec(PERIOD), self._publish)

    def _publish(self, _event):
        self._publisher.publish(data=self._next)
        self._next = (self._next + 2) & (2**32 - 1)


def main():
    rospy.init_node(NODE_NAME)
    rospy.loginfo("%s namespace of node = %s", TAG, rospy.get_name())
    numbers = OddNumbers()
    rospy.spin()


if __name__ == "__main__":
    main()
