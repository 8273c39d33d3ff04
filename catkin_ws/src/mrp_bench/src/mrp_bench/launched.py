# SPDX-License-Identifier: BSD-3-Clause
"""A launch as a student sees it: in a terminal, with the time of each line, ended by Ctrl-C."""

import os
import pathlib
import re
import signal
import subprocess
import threading
import time

from mrp_bench.processes import tree, with_parent
from mrp_bench.programs import ProgramError

# Seconds in which all nodes must be up, or have ended: on two cores, those of 50 robots take less
# than a minute.
_DEADLINE = 300

_ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_STARTED = re.compile(r"process\[(\S+?)(?:-\d+)?\]: started with pid \[(\d+)\]")
_READY = re.compile(r"\[(PUBLISHER|SUBSCRIBER) (CPP|PY) NODE\] namespace of \w+ = /(\w+/\w+)")
_RECEIVED = re.compile(r"\[(SUBSCRIBER \w+ NODE)\] received message with data = \d+")
_STOPPING = re.compile(r"\[([\w/]+)(?:-\d+)?\] killing on exit")
_MASTER = "setting /run_id to "  # what roslaunch does once the master that it has started answers
_EXIT = re.compile(r"process\[(\S+?)(?:-\d+)?\]: \w+ killed with return value (-?\d+)")


class Console:
    """What the lines of roslaunch and of the nodes say has happened.

    events: triples of the time; "first line", "master" (it answers), "started", "ready", "received"
      (the first message) or "stopping"; and the node's name without its first slash, or which
      subscriber it is, or nothing
    pids: node's name -> process id
    """

    def __init__(self):
        self.events = []
        self.pids = {}
        self._seen = set()
        self._subscribers = set()

    def add(self, moment, line):
        line = _ESCAPES.sub("", line)
        self._happened(moment, "first line", "")
        if _MASTER in line:
            self._happened(moment, "master", "")
        # Of several in one line: roslaunch's threads print at once.
        for name, pid in _STARTED.findall(line):
            self.pids[name] = int(pid)
            self._happened(moment, "started", name)
        for kind, language, name in _READY.findall(line):
            if kind == "SUBSCRIBER":
                self._subscribers.add(f"{kind} {language} NODE")
            self._happened(moment, "ready", name)
        for what, pattern in (("received", _RECEIVED), ("stopping", _STOPPING)):
            for name in pattern.findall(line):
                self._happened(moment, what, name)

    def _happened(self, moment, what, name):
        if (what, name) not in self._seen:
            self._seen.add((what, name))
            self.events.append((moment, what, name))

    def is_up(self, count):
        """Return whether that many nodes are ready, and each kind of subscriber has a message."""
        whats = [what for _, what, _ in list(self.events)]
        received = whats.count("received")
        return whats.count("ready") == count and received == len(self._subscribers)


def exits(log):
    """Return node's name -> exit code, of the text of roslaunch's own log; negative: a signal."""
    return {name: int(code) for name, code in _EXIT.findall(log)}


class Launched:
    """A command that starts nodes; times are in seconds since then.

    console: a Console, of what it has printed so far
    Use it in a `with`: on leaving, whatever is left of it is ended.
    """

    def __init__(self, command, env=None):
        self.console = Console()
        self._text = ""
        # In a terminal, and not in a pipe: there each program prints a line as soon as it has one.
        ours, terminal = os.openpty()
        self._begin = time.monotonic()
        self._process = subprocess.Popen(
            with_parent(command, signal.SIGINT),
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=terminal,
            stderr=terminal,
            start_new_session=True,
        )
        os.close(terminal)
        self._reader = threading.Thread(target=self._read, args=(ours,))
        self._reader.start()

    def now(self):
        return time.monotonic() - self._begin

    def _read(self, ours):
        with os.fdopen(ours, errors="replace") as stream:
            try:
                for line in stream:
                    self.console.add(self.now(), line)
                    self._text += line
            except OSError:
                pass  # so ends a terminal that nobody has open any more

    def wait_until_up(self, count):
        """Wait for Console.is_up(). Raises ProgramError if it ends before, or takes too long."""
        end = self.now() + _DEADLINE
        while not self.console.is_up(count):
            if self._process.poll() is not None or self.now() > end:
                raise ProgramError(f"expected {count} nodes that run, found:\n{self._text}")
            time.sleep(0.05)

    def pids(self):
        """Return the process ids of all that it has started."""
        return [pid for pid in tree(self._process.pid) if pid != self._process.pid]

    def stop(self, watched):
        """Do what Ctrl-C does; return when, when each of the watched had ended, and when all had.

        watched: name -> process id. Raises ProgramError if it does not end.
        """
        stop = self.now()
        self._process.send_signal(signal.SIGINT)
        ended = {}
        while self._process.poll() is None:
            for name, pid in watched.items():
                if name not in ended and not _runs(pid):
                    ended[name] = self.now()
            if self.now() > stop + _DEADLINE:
                raise ProgramError(f"expected roslaunch to end within {_DEADLINE} s of SIGINT")
            time.sleep(0.005)
        return stop, ended, self.now()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(30)
            except subprocess.TimeoutExpired:
                pass
        if self._process.poll() is None:
            for pid in reversed(tree(self._process.pid)):
                os.kill(pid, signal.SIGKILL)
            self._process.wait()
        self._reader.join()


def _runs(pid):
    """Return whether a process runs: one that only waits to be asked for its exit code does not."""
    try:
        return ") Z " not in pathlib.Path(f"/proc/{pid}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
