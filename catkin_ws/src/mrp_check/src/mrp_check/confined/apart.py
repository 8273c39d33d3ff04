# SPDX-License-Identifier: BSD-3-Clause
"""How the observer starts what it observes: so that it cannot reach the observer.

As root, what is observed runs as another user. As another user, with namespaces, it runs in a
sandbox within the sandbox: it sees no process but its own, and can write only into its own folders.
Both reach each other through ROS alone. Where neither is possible, nothing is apart: confine.py
says so.
"""

import json
import os
import signal
import subprocess
import time

import psutil

# Of the environment: what confine.run() knows of the user and of namespaces.
VARIABLE = "MRP_CHECK_APART"

_STARTING = 20.0  # seconds within which bubblewrap must have started a program


class Starter:
    """Starts programs apart from this process.

    user: the id of the user to start them as, or None for this one
    namespaces: whether this process is in namespaces of its own
    in_sandbox: whether each program gets a sandbox within them
    """

    def __init__(self, user, namespaces):
        self.in_sandbox = namespaces and user is None
        self._setpriv = ["setpriv", "--no-new-privs"]
        if user is not None:
            self._setpriv += [f"--reuid={user}", f"--regid={user}", "--clear-groups"]
            self._setpriv += ["--inh-caps=-all"]

    @classmethod
    def of_environment(cls):
        return cls(**json.loads(os.environ.pop(VARIABLE)))

    def start(self, command, writable, **options):
        """Start a command; return its Popen and the process that starts it in a sandbox, or None.

        writable: the folders that it may write to; options: those of Popen
        """
        if not self.in_sandbox:
            return subprocess.Popen([*self._setpriv, "--", *command], **options), None
        read, write = os.pipe()
        sandbox = ["bwrap", "--unshare-user", "--unshare-pid", "--ro-bind", "/", "/"]
        sandbox += ["--dev-bind", "/dev", "/dev", "--proc", "/proc", "--info-fd", str(write)]
        sandbox += [word for folder in writable for word in ("--bind", folder, folder)]
        popen = subprocess.Popen([*sandbox, "--", *command], pass_fds=(write,), **options)
        os.close(write)
        with os.fdopen(read) as file:
            said = json.loads(file.read() or "{}")
        try:
            return popen, psutil.Process(said["child-pid"])
        except (KeyError, psutil.NoSuchProcess):
            return popen, None  # it has ended already


def started_in(init):
    """Return the id of the program that a sandbox was made for, or None if it has ended."""
    end = time.monotonic() + _STARTING
    while time.monotonic() < end:
        try:
            children = init.children()
        except psutil.Error:
            return None
        if children:
            return children[0].pid
        time.sleep(0.005)
    return None


def id_outside(init, inside):
    """Return the id that a process has here; inside: its id within the sandbox, or None."""
    for process in init.children(recursive=True):
        try:
            with open(f"/proc/{process.pid}/status") as file:
                ids = next(line for line in file if line.startswith("NSpid:")).split()
        except (OSError, StopIteration):
            continue
        if ids[-1] == str(inside):
            return process.pid
    return None


def exit_code(popen, in_sandbox):
    """Return a program's exit code (negative: killed by that signal), or None while it runs.

    bubblewrap says 128 more than the signal, as a shell does.
    """
    code = popen.poll()
    if in_sandbox and code is not None and code > 128:
        return -(code - 128) if code - 128 in set(signal.Signals) else code
    return code
