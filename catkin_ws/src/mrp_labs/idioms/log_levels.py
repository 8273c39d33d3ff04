#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""Logs at each level. Use debug to find mistakes, info for what a user wants to know, and warn and
above for what needs action."""

import rospy


class LogLevels:
    def __init__(self):
        rospy.loginfo_once("once")
        self.timer = rospy.Timer(rospy.Duration(2), self.timer_callback)

    def timer_callback(self, event):
        rospy.logdebug("a debug line")
        rospy.loginfo("an info line")
        rospy.logwarn("a warning")
        rospy.logerr("an error")
        rospy.logfatal("a fatal error, but the node keeps running")
        rospy.loginfo_throttle(3600, "at most once an hour")


def main():
    # log_level=rospy.DEBUG here would show the debug lines, too.
    rospy.init_node("log_levels")
    node = LogLevels()
    rospy.spin()


if __name__ == "__main__":
    main()
