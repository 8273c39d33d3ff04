# SPDX-License-Identifier: BSD-3-Clause
"""A master for the measurements alone."""

import os
import signal
import socket
import subprocess
import time

import rosgraph

from mrp_bench.processes import with_parent


class Master:
    """roscore on a free port, of which all programs know that are started within this `with`.

    log: the file to which what it prints is appended
    """

    def __init__(self, log):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
        with open(log, "ab") as file:
            self._roscore = subprocess.Popen(
                with_parent(["roscore", "-p", str(port)], signal.SIGINT),
                stdout=file,
                stderr=file,
                start_new_session=True,
            )
        while self._roscore.poll() is None and not rosgraph.is_master_online():
            time.sleep(0.02)
        # While it is not set, each node asks for it at each line that it logs.
        rosgraph.Master("/bench").setParam("/rosout_disable_topics_generation", False)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._roscore.send_signal(signal.SIGINT)
        self._roscore.wait()
