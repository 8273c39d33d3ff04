# SPDX-License-Identifier: BSD-3-Clause
"""How the observer starts what it observes: so that it cannot reach the observer.

As root, what is observed runs as another user. As another user, with namespaces, it runs in a
sandbox within the sandbox: it sees no process but its own, and can write only into its own folders.
Both reach each other through ROS alone. Where neither is possible, nothing is apart: confine.py
says so.
"""

import dataclasses
import json
import os
import signal
import subprocess
import time
from typing import Any, Optional, Sequence, Tuple

import psutil

from mrp_check.confined import crossing, variables

_STARTING = 20.0  # seconds within which bubblewrap must have started a program
_TICK = 0.005  # seconds between two looks at whether it has


@dataclasses.dataclass
class Apart:
    """What confine.run() knows of how things can be kept apart.

    user: the id of the user to start programs as, or None for this process's own
    namespaces: whether this process is in namespaces of its own
    """

    user: Optional[int]
    namespaces: bool


class Starter:
    """Starts programs apart from this process.

    in_sandbox: whether each program gets a sandbox within the namespaces
    """

    def __init__(self) -> None:
        apart = crossing.from_json(Apart, os.environ.pop(variables.APART))
        self.in_sandbox = apart.namespaces and apart.user is None
        self._setpriv = ["setpriv", "--no-new-privs"]
        if apart.user is not None:
            self._setpriv += [f"--reuid={apart.user}", f"--regid={apart.user}", "--clear-groups"]
            self._setpriv += ["--inh-caps=-all"]

    def start(
        self, command: Sequence[str], writable: Sequence[str], **options: Any
    ) -> Tuple["subprocess.Popen[bytes]", Optional[psutil.Process]]:
        """Start a command; return its Popen and the process that starts it in a sandbox, or None.

        writable: the folders that it may write to; options: those of Popen
        """
        options["env"] = {**options["env"], variables.MARK: os.environ[variables.MARK]}
        if not self.in_sandbox:
            return subprocess.Popen([*self._setpriv, "--", *command], **options), None
        read, write = os.pipe()
        sandbox = ["bwrap", "--unshare-user", "--unshare-pid", "--ro-bind", "/", "/"]
        sandbox += ["--dev-bind", "/dev", "/dev", "--proc", "/proc", "--info-fd", str(write)]
        sandbox += [word for folder in writable for word in ("--bind", folder, folder)]
        popen = subprocess.Popen([*sandbox, "--", *command], pass_fds=(write,), **options)
        os.close(write)
        with os.fdopen(read) as file:
            info = json.loads(file.read() or "{}")
        try:
            return popen, psutil.Process(info["child-pid"])
        except (KeyError, psutil.NoSuchProcess):
            return popen, None  # it has ended already


def started_in(init: psutil.Process) -> Optional[int]:
    """Return the id of the program that a sandbox was made for, or None if it has ended."""
    end = time.monotonic() + _STARTING
    while time.monotonic() < end:
        try:
            children = init.children()
        except psutil.Error:
            return None
        if children:
            return children[0].pid
        time.sleep(_TICK)
    return None


def id_outside(init: psutil.Process, inside: str) -> Optional[int]:
    """Return the id that a process has here; inside: its id within the sandbox, or None."""
    for process in init.children(recursive=True):
        try:
            with open(f"/proc/{process.pid}/status") as file:
                ids = next(line for line in file if line.startswith("NSpid:")).split()
        except (OSError, StopIteration):
            continue
        if ids[-1] == inside:
            return process.pid
    return None


def exit_code(popen: "subprocess.Popen[bytes]", in_sandbox: bool) -> Optional[int]:
    """Return a program's exit code (negative: killed by that signal), or None while it runs.

    bubblewrap says 128 more than the signal, as a shell does.
    """
    code = popen.poll()
    if in_sandbox and code is not None and code > 128:
        return -(code - 128) if code - 128 in set(signal.Signals) else code
    return code
