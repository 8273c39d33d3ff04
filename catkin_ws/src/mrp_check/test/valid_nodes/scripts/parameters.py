#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Read a whole group of parameters, of which the launch file sets each by its own name."""

import rospy
from std_msgs.msg import Float64


def main():
    rospy.init_node("parameters")
    gains = rospy.get_param("~gains")
    red = rospy.get_param("~background_r", 69)
    publisher = rospy.Publisher("gain", Float64, queue_size=10)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        publisher.publish(gains["P"] * red)
        rate.sleep()


if __name__ == "__main__":
    main()
