#!/usr/bin/env python
"""Publishes 1, 2, 3, ... on "numbers", one every half second."""

import rospy
from relay.msg import Count


class CounterNode:
    def __init__(self):
        self.counter = 1
        self.publisher = rospy.Publisher("numbers", Count, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(0.5), self.timer_callback)

    def timer_callback(self, event):
        self.publisher.publish(Count(count=self.counter))
        self.counter = (self.counter + 1) % 2**32


def main():
    rospy.init_node("counter_node")
    node = CounterNode()
    rospy.spin()


if __name__ == "__main__":
    main()
