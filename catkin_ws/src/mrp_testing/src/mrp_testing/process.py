# SPDX-License-Identifier: BSD-3-Clause
"""Programs under test: started as a child process, read through a pipe, stopped by a signal."""

import os
import pathlib
import re
import signal
import subprocess
import threading

from mrp_testing.waiting import DEADLINE, wait_until

# Colours, and the window title that roslaunch sets.
ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")

# What a shell runs in the background ignores SIGINT, and so would all that is started here; but a
# handler is not inherited.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# With these, a node prints each line at once also into a pipe: the first for C++, then for Python.
LIVE = {"ROSCONSOLE_STDOUT_LINE_BUFFERED": "1", "PYTHONUNBUFFERED": "1"}


class Process:
    """A running program, whose output lines are collected as they arrive.

    lines: all lines so far, of stdout and stderr, without colours
    errors: those of stderr

    env: the environment, if not the test's own; the variables of LIVE are taken out of it
    extra_env: what comes on top of that

    Use it in a `with`: on leaving, whatever is left of the program is killed.
    """

    def __init__(self, *command, env=None, extra_env=None):
        self.command = command
        self.lines = []
        self.errors = []
        env = dict(os.environ if env is None else env)
        for name in LIVE:
            env.pop(name, None)
        env.update(extra_env or {})
        self._popen = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            env=env,
            start_new_session=True,
        )
        self.pid = self._popen.pid
        self._readers = [
            threading.Thread(target=self._read, args=(self._popen.stdout, [self.lines])),
            threading.Thread(
                target=self._read, args=(self._popen.stderr, [self.lines, self.errors])
            ),
        ]
        for reader in self._readers:
            reader.start()

    @property
    def code(self):
        """The exit code (negative: killed by that signal), or None while the program runs."""
        return self._popen.poll()

    @staticmethod
    def _read(stream, targets):
        with stream:
            for line in stream:
                text = ESCAPES.sub("", line).rstrip("\n")
                for target in targets:
                    target.append(text)

    def wait_for(self, condition, what):
        """Wait until condition() is true; fail if the program ends before.

        `what` says what is waited for; it may be a function, to say at the end how far it got.
        """

        def met_or_ended():
            return condition() or self.code is not None

        def explain():
            return f"{what() if callable(what) else what}\n{self}"

        wait_until(met_or_ended, explain)
        assert condition(), "the program ended before: " + explain()

    def wait_until_it_sleeps(self):
        """Wait until the main thread has gone to sleep a few more times, as in a loop or in spin().

        A node that the master knows may still be registering. rospy hangs if Ctrl-C comes then:
        its handler calls the master, too, and waits for the lock of the call that it has
        interrupted (_ServerProxy__request in rospy/core.py).
        """
        status = pathlib.Path(f"/proc/{self.pid}/task/{self.pid}/status")

        def sleeps():
            return int(re.search(r"\nvoluntary_ctxt_switches:\s(\d+)", status.read_text())[1])

        before = sleeps()
        self.wait_for(lambda: sleeps() >= before + 4, "it sleeps")

    def stop(self, signal_number=signal.SIGINT):
        """Send a signal, wait for the end and return the exit code (negative: killed by it)."""
        os.kill(self.pid, signal_number)
        return self.wait()

    def wait(self):
        """Wait for the end and return the exit code (negative: killed by that signal)."""
        code = self._popen.wait(DEADLINE)
        for reader in self._readers:
            reader.join(DEADLINE)
        return code

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        if self.code is None:
            # roslaunch's nodes are in sessions of their own: let it end them first.
            os.kill(self.pid, signal.SIGINT)
            try:
                self.wait()
            except subprocess.TimeoutExpired:
                pass
        try:
            os.killpg(self.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.wait()

    def __str__(self):
        return "--- {}:\n{}\n---".format(" ".join(self.command), "\n".join(self.lines))


def processes_with(text):
    """Return process id -> command line, of all processes but this one that have a text in their
    command line, or in the environment that they were started with."""
    found = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        command = _read_if_there(folder / "cmdline")
        printed = command + _read_if_there(folder / "environ")
        if text.encode() in printed and int(folder.name) != os.getpid():
            found[int(folder.name)] = command.replace(b"\0", b" ").decode(errors="replace")
    return found


def _read_if_there(path):
    """Return the bytes of a process's file; none if it has ended, or is another user's."""
    try:
        return path.read_bytes()
    except OSError:
        return b""
