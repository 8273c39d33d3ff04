#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The clock of the labs: all nodes go by it, if /use_sim_time is true when they start."""

import sys
import time

import rospy
from rosgraph_msgs.msg import Clock

BEGIN = 1000  # the first time, in seconds


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_clock_py_node")
    factor = rospy.get_param("~factor", 1)  # how much faster it goes
    jump = rospy.get_param("~jump", 0)  # seconds: forward, then back, forward, ...
    jump_every = rospy.get_param("~jump_every", 5)  # seconds, not simulated

    publisher = rospy.Publisher("/clock", Clock, queue_size=10)
    rospy.loginfo(f"{rospy.get_name()} publishes /clock from {BEGIN} on, {factor} times as fast")
    begin = time.monotonic()
    jumps = 0
    while not rospy.is_shutdown():
        elapsed = time.monotonic() - begin
        if jump and elapsed >= (jumps + 1) * jump_every:
            jumps += 1
            direction = "forward" if jumps % 2 else "back"
            rospy.loginfo(f"{rospy.get_name()} jumps {jump} s {direction}")
        now = BEGIN + elapsed * factor + jump * (jumps % 2)
        publisher.publish(rospy.Time.from_sec(now))
        time.sleep(0.01)  # rospy.sleep would wait for the clock, which is this one


if __name__ == "__main__":
    main()
