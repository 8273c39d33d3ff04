#!/usr/bin/env python
import rospy
from std_msgs.msg import UInt32


def odd_numbers():
    """Without end: after the largest odd number that a UInt32 can hold comes 1 again."""
    while True:
        for number in range(1, 2**32, 2):
            yield number


def main():
    rospy.init_node("publisher_py_node")
    rospy.loginfo("[PUBLISHER PY NODE] namespace of node = " + rospy.get_name())
    publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)
    rate = rospy.Rate(2)
    for number in odd_numbers():
        if rospy.is_shutdown():
            break
        publisher.publish(number)
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            break


if __name__ == "__main__":
    main()
