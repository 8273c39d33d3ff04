#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a node whose end takes so long that its timers could fire once more.

On Ctrl-C, rospy closes the publishers, and only then do rospy.is_shutdown() and the timers know
that the node ends. Between the two there is a moment in which publish() raises an exception. Here
this moment lasts until the timers have ended: in peace, or by that exception.

    slow_end.py NODE
"""

import runpy
import sys
import threading

import rospy
from mrp_testing.waiting import DEADLINE

init_node = rospy.init_node


def wait_for_timers(reason):
    for thread in threading.enumerate():
        if isinstance(thread, rospy.Timer):
            thread.join(DEADLINE)


def init_node_with_slow_end(*args, **kwargs):
    init_node(*args, **kwargs)
    # After the hook with which rospy itself closes the publishers.
    rospy.core.add_preshutdown_hook(wait_for_timers)


rospy.init_node = init_node_with_slow_end
runpy.run_path(sys.argv[1], run_name="__main__")
