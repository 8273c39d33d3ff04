# SPDX-License-Identifier: BSD-3-Clause
"""A program that runs under observation: its output, its end, and what it leaves behind."""

import collections
import os
import re
import signal
import subprocess
import threading
import time
from typing import IO, Deque, List, Mapping, Optional, Sequence, Tuple

import psutil

from mrp_check.confined import apart, warden
from mrp_check.confined.seen import Left, OutputLine

_ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_NOT_EXECUTED = re.compile(r"(bwrap: execvp|setpriv: failed to execute) ")
_LINES, _LAST_LINES = 5000, 500  # that are kept of a program's output, at its begin and its end
_LINE_BYTES = 4096  # a longer line is cut into several
_REST_SECONDS = 1.0  # that the rest of an output is waited for


class Program:
    """A running program whose lines are collected as they come.

    pid: the program's own, or None if it has ended already
    started, ended: by time.monotonic(); ended is None as long as poll() has not seen it end
    """

    def __init__(
        self,
        starter: apart.Starter,
        command: Sequence[str],
        env: Mapping[str, str],
        writable: Sequence[str],
        merge: bool = False,
    ) -> None:
        self.lines: List[OutputLine] = []
        self._last: Deque[Tuple[float, str, bytes]] = collections.deque(maxlen=_LAST_LINES)
        self.line_count = 0
        self.started = time.monotonic()
        self.ended: Optional[float] = None
        self._popen, self.init = starter.start(
            command,
            writable,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if merge else subprocess.PIPE,
            env=env,
            cwd=writable[0],
            start_new_session=True,
        )
        self._in_sandbox = starter.in_sandbox
        self.pid: Optional[int] = self._popen.pid
        if self._in_sandbox:
            self.pid = apart.started_in(self.init) if self.init else None
        streams = [("out", self._popen.stdout), ("err", self._popen.stderr)]
        self._readers = [
            threading.Thread(target=self._read, args=stream, daemon=True)
            for stream in streams
            if stream[1]
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, name: str, stream: IO[bytes]) -> None:
        while True:
            data = stream.readline(_LINE_BYTES)
            if not data:
                return
            self.line_count += 1
            if len(self.lines) < _LINES:
                self.lines.append((time.monotonic() - self.started, name, _text(data)))
            else:
                self._last.append((time.monotonic() - self.started, name, data))

    def poll(self) -> Optional[int]:
        """Return the exit code, or None while it runs."""
        code = apart.exit_code(self._popen, self._in_sandbox)
        if code is not None and self.ended is None:
            self.ended = time.monotonic()
        return code

    def send(self, number: int) -> None:
        if self.pid and self._popen.poll() is None:
            _send(self.pid, number)

    def kill(self) -> None:
        if self.init:
            _send(self.init.pid, signal.SIGKILL)  # and with it all that is in its sandbox
        try:
            os.killpg(self._popen.pid, signal.SIGKILL)
        except OSError:
            pass
        self._popen.wait()

    def owns(self, process: psutil.Process) -> bool:
        """Return whether a process comes from this program, as far as that can still be seen."""
        try:
            if self.init:
                return self.init in process.parents()
            return os.getsid(process.pid) == self._popen.pid
        except (OSError, psutil.Error):
            return False

    def was_executed(self) -> bool:
        """Return whether the system could execute it: it may lack the right first line."""
        return not any(_NOT_EXECUTED.match(text) for _, _, text in self.lines[:1])

    def all_lines(self) -> List[OutputLine]:
        """Wait until all output is read, and return the lines that are kept; not for ever: a child
        may keep the pipe open."""
        for reader in self._readers:
            reader.join(_REST_SECONDS)
        return [*self.lines, *((at, name, _text(data)) for at, name, data in list(self._last))]


def _text(data: bytes) -> str:
    return _ESCAPES.sub("", data.decode("utf-8", "replace")).rstrip("\r\n")


def _send(pid: int, number: int) -> None:
    try:
        os.kill(pid, number)
    except OSError:
        pass  # it has ended meanwhile


def left_behind(programs: Mapping[Optional[str], Program]) -> List[Left]:
    """Return the processes that have come of these programs and are still there, and kill them.

    programs: key -> Program; what is found has the key of its program, if that can be told
    """
    makers = {program.init.pid for program in programs.values() if program.init}
    left = [process for process in warden.descendants() if process.pid not in makers]
    found = [
        Left(
            warden.command_of(process),
            next((key for key, program in programs.items() if program.owns(process)), None),
        )
        for process in left
    ]
    for pid in [process.pid for process in left] + list(makers):
        _send(pid, signal.SIGKILL)
    return found
