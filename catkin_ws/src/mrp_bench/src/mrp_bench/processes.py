# SPDX-License-Identifier: BSD-3-Clause
"""Processes: what they use, and that they do not outlive the one that starts them."""

import pathlib
import re
import signal


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


def of_threads(pids, name):
    """Return the texts of a file in /proc of all threads of these processes."""
    texts = []
    for pid in pids:
        for path in pathlib.Path(f"/proc/{pid}/task").glob(f"*/{name}"):
            try:
                texts.append(path.read_text())
            except (FileNotFoundError, ProcessLookupError):
                pass  # it has just ended
    return texts


def cpu(pids):
    """Return the processor time that these processes have used so far, in seconds."""
    return sum(int(text.split()[0]) / 1e9 for text in of_threads(pids, "schedstat"))


def megabytes(pid):
    """Return the memory of a process; what several share is divided among them (proc(5): Pss)."""
    text = pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text()
    return int(re.search(r"^Pss:\s*(\d+)", text, re.MULTILINE).group(1)) / 1024
