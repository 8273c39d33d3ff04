# SPDX-License-Identifier: BSD-3-Clause
"""A master for tests that need one of their own, as roscore starts it."""

import rosgraph

from mrp_testing.process import Process


def uri_of(port):
    """Return the ROS_MASTER_URI of a master at a port of this machine."""
    return f"http://localhost:{port}"


def master(port):
    """Return a running master at a port, as a Process, once it answers."""
    core = Process("rosmaster", "--core", "-p", str(port))
    core.wait_for(lambda: rosgraph.is_master_online(uri_of(port)), "a master that answers")
    return core
