#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The timers and loops of the labs: each turn publishes the number of turns. The private parameter
~timer says what a turn waits for: the first two are timers, and the others are loops."""

import contextlib
import sys
import time

import rospy
from std_msgs.msg import UInt32


class LabTimer:
    def __init__(self):
        self.timer = rospy.get_param("~timer", "ros")
        self.period = rospy.get_param("~period", 0.5)  # seconds
        self.work = rospy.get_param("~work", 0.0)  # seconds of the ROS clock in each turn
        self.turns = 0
        self.publisher = rospy.Publisher("great_topic", UInt32, queue_size=10)

    def run(self):
        if self.timer in ("ros", "ros-reset"):
            # Before Debian 14, a timer without reset ends when the ROS clock jumps back.
            reset = self.timer == "ros-reset"
            timer = rospy.Timer(rospy.Duration(self.period), self.turn, reset=reset)
            rospy.spin()
        elif self.timer in ("steady", "rate", "sleep"):
            self.loop()
        else:
            sys.exit(f"expected ~timer: ros, ros-reset, steady, rate or sleep; found {self.timer}")

    def loop(self):
        rate = rospy.Rate(1 / self.period)
        while not rospy.is_shutdown():
            if self.timer == "steady":  # rospy has no timer but the one that follows the ROS clock
                time.sleep(self.period)
            self.turn()
            if self.timer == "rate":
                rate.sleep()
            elif self.timer == "sleep":
                rospy.sleep(self.period)

    def turn(self, event=None):
        self.turns += 1
        self.publisher.publish(self.turns)
        rospy.loginfo(f"{rospy.get_name()} published {self.turns}")
        end = rospy.get_time() + self.work
        while not rospy.is_shutdown() and rospy.get_time() < end:
            time.sleep(0.002)


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_timer_py_node")
    with contextlib.suppress(rospy.ROSInterruptException):  # at Ctrl-C, in a sleep
        LabTimer().run()


if __name__ == "__main__":
    main()
