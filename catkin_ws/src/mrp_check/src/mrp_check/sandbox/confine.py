# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command that is not trusted: within limits, and with nothing of it left afterwards.

Always, as any user:
- the command has a session and a process group, and a HOME, TMPDIR, ROS_HOME and ROS_LOG_DIR of its
  own, in a scratch folder;
- it is ended when it breaks a limit: see Limits. A watching process and rlimits see to that;
- its output is read to the end, and kept up to a limit;
- every process that it started is killed when it ends, even if it has detached itself: the watcher
  (confined/warden.py) adopts all orphans.

With namespaces, which bubblewrap makes where the system lets it (Debian does; Docker's default does
not), also:
- the command sees and signals none of the machine's other processes, and its watcher cannot be
  killed from within;
- there is no network but its own loopback: so no port is taken, and nothing can be sent anywhere;
- of the machine's files it sees the programs in /usr and a few of /etc, read-only. There are no
  homes, no other submissions, and no sockets.

As root, the command runs as another user, who owns the scratch folder and nothing else. This holds
without namespaces, too: the command cannot write or read what is root's, nor signal it.

As another user and without namespaces, a command that means harm could still read and write its
user's files, signal its user's processes, and use the network. `isolation()` says what holds.
"""

from __future__ import annotations

import contextlib
import dataclasses
import os
import selectors
import signal
import subprocess
import tempfile
import time
import uuid
from typing import IO, Callable, Iterator, Mapping, Sequence

import psutil

from mrp_check import sandbox
from mrp_check.confined import apart, crossing, variables, warden
from mrp_check.confined.warden import MEGABYTE, Limits
from mrp_check.sandbox import ConfineError

_RUNNING: set[IO[bytes]] = set()  # the standard inputs of the watchers of all runs

# Seconds that the watcher may take, after a limit, to kill all and to say so.
_GRACE = 20
# So many times what is kept of the output may be written before the command is ended for it.
_FLOOD = 50
_CHUNK = 2**16  # bytes that are read at once


@dataclasses.dataclass
class Result:
    """How a command ended.

    code: its exit code (negative: killed by that signal), or None if it was ended for a limit
    ended_by: the limit that it broke: "time", "memory", "processes", "disk" or "output"; "caller";
        or None if it ended by itself
    output, errors: what is kept of standard output and of standard error
    cut: whether some of the two was not kept
    left: command lines of processes that were still there after it had ended (they are killed)
    """

    code: int | None
    ended_by: str | None
    seconds: float
    output: str
    errors: str
    cut: bool
    left: list[str]

    def limit_text(self, limits: Limits) -> str | None:
        """Return a sentence that says which limit was broken, or None."""
        sentences = {
            "time": f"it didn't end within {limits.time:.0f} s",
            "memory": f"it used more than {limits.memory // MEGABYTE} MB of memory",
            "processes": f"it started more than {limits.processes} processes and threads",
            "disk": f"it wrote more than {limits.disk // MEGABYTE} MB, or too deep folders",
            "output": f"it printed more than {_FLOOD * limits.output // MEGABYTE} MB",
        }
        return sentences.get(self.ended_by or "")


def run(
    command: Sequence[object],
    scratch: str | os.PathLike[str],
    limits: Limits | None = None,
    env: Mapping[str, str] | None = None,
    readable: Sequence[str | os.PathLike[str]] = (),
    writable: Sequence[str | os.PathLike[str]] = (),
    namespaces: bool = True,
    observes: bool = False,
) -> Result:
    """Run a command to its end, or to the first limit that it breaks.

    scratch: where it starts, and the only folder that it is meant to write to
    env: its whole environment, if not that of variables.environment(scratch)
    readable: more folders that it may read
    writable: more folders that it may write to, such as a compiler's cache
    namespaces: False makes none, even where they could be made
    observes: it is the checker's own, and starts what is not trusted as confined/apart.py says

    Raises ConfineError.
    """
    scratch, mark = os.path.realpath(scratch), uuid.uuid4().hex
    env = {**(variables.environment(scratch) if env is None else env), variables.MARK: mark}
    user = sandbox.hand_over(scratch)
    namespaces = namespaces and sandbox.isolation() is sandbox.Isolation.NAMESPACES
    if observes:
        env[variables.APART] = crossing.to_json(apart.Apart(user, namespaces))
    words = [str(word) for word in command]
    task = warden.Task(words, scratch, env, limits or Limits(), user, namespaces, observes)
    with contextlib.ExitStack() as stack:
        box = stack.enter_context(_namespaces(scratch, readable, writable)) if namespaces else []
        return _watched(box, task, None if namespaces or user is not None else mark)


@contextlib.contextmanager
def _namespaces(
    scratch: str,
    readable: Sequence[str | os.PathLike[str]],
    writable: Sequence[str | os.PathLike[str]],
) -> Iterator[list[str]]:
    """Yield the command that makes the namespaces of one run, with a /tmp of their own."""
    # It lies beside the scratch folder, where nothing is safe.
    with tempfile.TemporaryDirectory(prefix="tmp_", dir=os.path.dirname(scratch)) as tmp:
        os.chmod(tmp, 0o1777)
        binds = [("--bind", tmp, "/tmp")]
        given = {"--ro-bind": [sandbox.PACKAGE, *readable], "--bind": [scratch, *writable]}
        for option, paths in given.items():
            binds += [(option, path, path) for path in map(os.path.realpath, paths)]
        yield sandbox.bubblewrap(binds)


def stop() -> None:
    """End all that runs at this moment; each run() returns then."""
    for stdin in list(_RUNNING):
        stdin.close()


def _watched(box: Sequence[str], task: warden.Task, mark: str | None) -> Result:
    """Have a watcher do its task; return what came of it. Raises ConfineError.

    box: the command that makes the namespaces, if there are any
    mark: that of what runs, if it could kill its watcher
    """
    watcher, stdin, pipes = _start(box, task)
    _RUNNING.add(stdin)
    # When the watcher has ended, so has all that it watched over; or else it is ended now.
    reader = _Reader(pipes, task.limits.output, on_report=lambda: _kill_marked(mark))
    try:
        flood = reader.read(task.limits.time + _GRACE)
        if flood:
            # The end of its standard input tells it to kill all. What it writes goes on to be
            # read, so that it does not stand still at a full pipe.
            stdin.close()
            reader.read(_GRACE, flood=False)
    finally:
        _RUNNING.discard(stdin)
        stdin.close()  # which makes the watcher end
        try:
            watcher.wait(_GRACE)
        except subprocess.TimeoutExpired:
            os.killpg(watcher.pid, signal.SIGKILL)
            watcher.wait()
        _kill_marked(mark)
        for pipe in pipes.values():
            pipe.close()
    return _result(reader, flood)


def _start(
    box: Sequence[str], task: warden.Task
) -> tuple[subprocess.Popen[bytes], IO[bytes], dict[str, IO[bytes]]]:
    """Start a watcher and hand it its task; return it, its standard input, and what to read."""
    task_read, task_write = os.pipe()
    report_read, report_write = os.pipe()
    try:
        # Debian's own Python, without the user's settings: the checker's may be anything.
        python = ["/usr/bin/python3", "-I", str(sandbox.PACKAGE / "confined" / "warden.py")]
        watcher = subprocess.Popen(
            [*box, *python, str(task_read), str(report_write)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            pass_fds=(task_read, report_write),
            start_new_session=True,
            cwd="/",
            env={},
        )
    finally:
        os.close(task_read)
        os.close(report_write)
    # It may have ended already: its output says why.
    with contextlib.suppress(BrokenPipeError), os.fdopen(task_write, "w") as file:
        file.write(crossing.to_json(task))
    report = os.fdopen(report_read, "rb")
    assert watcher.stdin and watcher.stdout and watcher.stderr
    pipes = {"output": watcher.stdout, "errors": watcher.stderr, "report": report}
    return watcher, watcher.stdin, pipes


def _result(reader: _Reader, flood: bool) -> Result:
    try:
        report = crossing.from_json(warden.Outcome, reader.text("report"))
    except crossing.CrossingError:
        lines = reader.text("errors").strip().splitlines()
        raise ConfineError(
            "the process that watches over the package's programs was ended"
            + (f": {lines[-1]}" if lines else "")
        ) from None
    if not report.all_dead:
        raise ConfineError("some processes of the package couldn't be killed")
    return Result(
        code=report.code if report.ended_by is None else None,
        ended_by="output" if flood else report.ended_by,
        seconds=report.seconds,
        output=reader.text("output"),
        errors=reader.text("errors"),
        cut=reader.cut,
        left=report.left,
    )


def _kill_marked(mark: str | None) -> None:
    """Kill what bears a run's mark: after its watcher was killed, the only thing to know it by.

    mark: None where they could not have killed it
    """
    found = bool(mark)
    while found:
        found = False
        for process in psutil.process_iter():
            with contextlib.suppress(psutil.Error):
                if process.environ().get(variables.MARK) == mark:
                    found = True
                    process.kill()


class _Reader:
    """Reads pipes to their end; keeps of each the first `limit` bytes."""

    def __init__(
        self, pipes: Mapping[str, IO[bytes]], limit: int, on_report: Callable[[], None]
    ) -> None:
        self.limit, self.on_report = limit, on_report
        self.cut = False
        self._open = dict(pipes)
        self._kept = {name: bytearray() for name in pipes}
        self._seen = dict.fromkeys(pipes, 0)

    def text(self, name: str) -> str:
        return self._kept[name].decode("utf-8", errors="replace")

    def read(self, seconds: float, flood: bool = True) -> bool:
        """Read until all have ended, or for so long; with `flood`, until there is too much.

        Returns whether there was too much.
        """
        deadline = time.monotonic() + seconds
        with selectors.DefaultSelector() as selector:
            for name, pipe in self._open.items():
                selector.register(pipe, selectors.EVENT_READ, name)
            while self._open:
                for key, _ in selector.select(max(0, deadline - time.monotonic())):
                    data = os.read(key.fd, _CHUNK)
                    if not data:
                        selector.unregister(key.fileobj)
                        del self._open[key.data]
                        if key.data == "report":
                            self.on_report()
                    self._seen[key.data] += len(data)
                    kept = self._kept[key.data]
                    room = self.limit - len(kept)
                    kept += data[: max(0, room)]
                    self.cut = self.cut or len(data) > room
                    if flood and self._seen[key.data] > _FLOOD * self.limit:
                        return True
                if time.monotonic() > deadline:
                    return False
        return False


def remove(folder: str | os.PathLike[str]) -> None:
    """Delete a scratch folder, also where the command took away its own rights to it.

    However deep it is: Python's own functions end where their recursion does.
    """
    if subprocess.run(["rm", "-rf", folder], stderr=subprocess.DEVNULL).returncode:
        subprocess.run(["chmod", "-R", "u+rwX", folder], check=True)
        subprocess.run(["rm", "-rf", folder], check=True)
