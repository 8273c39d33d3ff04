# SPDX-License-Identifier: BSD-3-Clause
"""What every lab's node does before it publishes or subscribes. The twin of start.h."""

import time

import rospy


def wait(seconds):
    """Wait for so many seconds, or until Ctrl-C."""
    end = time.monotonic() + seconds
    while not rospy.is_shutdown() and time.monotonic() < end:
        time.sleep(0.02)


def work(seconds):
    """Work for so many seconds of the ROS clock, or until Ctrl-C."""
    end = rospy.get_time() + seconds
    while not rospy.is_shutdown() and rospy.get_time() < end:
        time.sleep(0.002)


def print_namespaces():
    """Print the namespace in which the node is, and its own."""
    rospy.loginfo(
        f"{rospy.get_name()} is in the namespace {rospy.get_namespace()}"
        f" (rospy.get_namespace()); its own is {rospy.get_name()} (rospy.get_name())"
    )
