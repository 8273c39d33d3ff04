#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The clock of the labs: all nodes go by it, if /use_sim_time is true when they start."""

import sys
import time

import rospy
from mrp_labs.parameters import Parameters
from rosgraph_msgs.msg import Clock

BEGIN = 1000  # the first time, in seconds


class LabClock:
    def __init__(self, parameters):
        self.factor = parameters.get("factor", 1)  # how much faster it goes
        self.period = parameters.get("period", 0.01)  # seconds between two messages
        self.jump = parameters.get("jump", 0)  # seconds: forward, then back, forward, ...
        self.jump_every = parameters.get("jump_every", 5)  # seconds, not simulated
        parameters.no_others()

    def run(self):
        publisher = rospy.Publisher("/clock", Clock, queue_size=10)
        rospy.loginfo(
            f"{rospy.get_name()} publishes /clock from {BEGIN} on, {self.factor} times as fast"
        )
        begin = time.monotonic()
        jumps = 0
        while not rospy.is_shutdown():
            elapsed = time.monotonic() - begin
            if self.jump and elapsed >= (jumps + 1) * self.jump_every:
                jumps += 1
                direction = "forward" if jumps % 2 else "back"
                rospy.loginfo(f"{rospy.get_name()} jumps {self.jump} s {direction}")
            now = BEGIN + elapsed * self.factor + self.jump * (jumps % 2)
            publisher.publish(Clock(rospy.Time.from_sec(now)))
            time.sleep(self.period)  # rospy.sleep would wait for the clock, which is this one


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_clock_py_node")

    try:
        node = LabClock(Parameters())
    except ValueError as error:
        rospy.logfatal(f"{rospy.get_name()}: {error}")
        sys.exit(1)
    node.run()


if __name__ == "__main__":
    main()
