#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Show a path in a help text, and take the real one from a parameter."""

import rospy
from std_msgs.msg import String

HELP = "Give the map as _map:=/home/NAME/map.yaml, for example."


def main():
    rospy.init_node("help_text")
    publisher = rospy.Publisher("map", String, queue_size=10, latch=True)
    publisher.publish(rospy.get_param("~map", HELP))
    rospy.spin()


if __name__ == "__main__":
    main()
