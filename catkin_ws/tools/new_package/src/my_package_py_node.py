#!/usr/bin/env python3
"""Doubles the numbers it receives."""

import rospy
from std_msgs.msg import Float64


class MyPackageNode:
    def __init__(self):
        # The publisher comes first: it must be there when the first number arrives.
        self.publisher = rospy.Publisher("output", Float64, queue_size=10)
        self.subscriber = rospy.Subscriber("input", Float64, self.input_callback, queue_size=10)

    def input_callback(self, msg):
        self.publisher.publish(Float64(2 * msg.data))


def main():
    rospy.init_node("my_package_py_node")
    node = MyPackageNode()
    rospy.spin()


if __name__ == "__main__":
    main()
