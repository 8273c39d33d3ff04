# SPDX-License-Identifier: BSD-3-Clause
"""Processes: what they use, that they do not outlive the one that starts them, and a master."""

import os
import pathlib
import re
import signal
import socket
import subprocess
import time

import rosgraph


def with_parent(command, number=signal.SIGKILL):
    """Return the command with which a program gets that signal when the thread that starts it ends.

    So nothing is left behind where a process is killed, which then cannot end what it has started.
    SIGKILL is for those that stand still: it is the only one that ends them.
    """
    # setpriv becomes the program: there is no other process.
    return ["setpriv", "--pdeathsig", signal.Signals(number).name, *command]


def tree(pid):
    """Return the process ids of a process and of all its descendants that run."""
    pids = [pid]
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            for child in task.read_text().split():
                pids += tree(int(child))
        except (FileNotFoundError, ProcessLookupError):
            pass  # it has just ended
    return pids


def cpu(pids):
    """Return the processor time that all threads of these processes have used, in seconds."""
    nanoseconds = 0
    for pid in pids:
        for path in pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat"):
            try:
                nanoseconds += int(path.read_text().split()[0])
            except (FileNotFoundError, ProcessLookupError):
                pass  # it has just ended
    return nanoseconds / 1e9


def megabytes(pid):
    """Return the memory of a process; what several share is divided among them (proc(5): Pss)."""
    text = pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text()
    return int(re.search(r"^Pss:\s*(\d+)", text, re.MULTILINE).group(1)) / 1024


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
