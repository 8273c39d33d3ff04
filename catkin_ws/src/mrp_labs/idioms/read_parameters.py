#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a parameter once, and again at each turn. Once is enough for what never changes. Each turn
asks the master, so only do that for what may change while the node runs."""

import rospy


class ReadParameters:
    def __init__(self):
        # Relative: all nodes in a group read the same one.
        self.robot = rospy.get_param("robot_name", "nobody")
        # Private: ~ stands for the node's own name.
        self.first_speed = rospy.get_param("~speed", 1.0)
        self.timer = rospy.Timer(rospy.Duration(2), self.timer_callback)

    def timer_callback(self, event):
        speed = rospy.get_param("~speed", 1.0)
        name = rospy.get_name()
        rospy.loginfo("%s %s: at first %s, now %s", name, self.robot, self.first_speed, speed)


def main():
    rospy.init_node("read_parameters")
    node = ReadParameters()
    rospy.spin()


if __name__ == "__main__":
    main()
