# SPDX-License-Identifier: BSD-3-Clause
"""A launch as a student sees it: in a terminal, with the time of each line, ended by Ctrl-C."""

import os
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
_READY = re.compile(r"\[(\w+ \w+ NODE)\] namespace of \w+ = /(\w+/\w+)")
_RECEIVED = re.compile(r"\[(SUBSCRIBER \w+ NODE)\] received message with data = \d+")


class Console:
    """What the lines of the nodes say has happened.

    ready: node's name without its first slash -> the time of its first line
    """

    def __init__(self):
        self.ready = {}
        self._subscribers = set()  # kinds of those that are ready
        self._received = set()  # kinds of those that have a message

    def add(self, moment, line):
        line = _ESCAPES.sub("", line)
        for kind, name in _READY.findall(line):
            self.ready.setdefault(name, moment)
            if kind.startswith("SUBSCRIBER"):
                self._subscribers.add(kind)
        self._received.update(_RECEIVED.findall(line))

    def is_up(self, count):
        """Return whether that many nodes are ready, and each kind of subscriber has a message."""
        return len(self.ready) == count and self._subscribers == self._received


class Launched:
    """A command that starts nodes; times are in seconds since then.

    console: a Console, of what it has printed so far
    Use it in a `with`: on leaving, whatever is left of it is ended.
    """

    def __init__(self, command):
        self.console = Console()
        self._text = ""
        # In a terminal, and not in a pipe: there each program prints a line as soon as it has one.
        ours, terminal = os.openpty()
        self._begin = time.monotonic()
        self._process = subprocess.Popen(
            with_parent(command, signal.SIGINT),
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

    def stop(self):
        """Do what Ctrl-C does; return when, and when all had ended.

        Raises ProgramError if it does not end.
        """
        stop = self.now()
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(_DEADLINE)
        except subprocess.TimeoutExpired:
            raise ProgramError(
                f"expected roslaunch to end within {_DEADLINE} s of SIGINT"
            ) from None
        return stop, self.now()

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
