# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command that is not trusted: within limits, and with nothing of it left afterwards.

Always, as any user:
- the command has a session and a process group, and a HOME, TMPDIR, ROS_HOME and ROS_LOG_DIR of its
  own, in a scratch folder;
- it is ended when it breaks a limit: see Limits;
- its output is read to the end, and kept up to a limit;
- every process that it started is killed when it ends, however that one has detached itself: a
  watching process (warden.py) adopts all orphans. If somebody kills the watcher, what bears the
  mark of this run in its environment is killed all the same.

Where the system lets this user make namespaces (Debian does; Docker's default does not), besides:
- the command sees and signals none of the machine's other processes, and its watcher cannot be
  killed from within;
- there is no network but its own loopback: so no port is taken, and nothing can be sent anywhere;
- all files but those of the scratch folder and of a private /tmp are read-only.

Without namespaces, a command that means harm could still write wherever its user may write, signal
its user's other processes, and use the network: check what you do not trust in a container without
a network, as the page on marking says. `isolation()` tells which of the two holds.
"""

import dataclasses
import functools
import json
import os
import pathlib
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import uuid
from typing import List, Optional, Sequence

_WARDEN = pathlib.Path(__file__).resolve().parent / "confined" / "warden.py"
_MARK = "MRP_CHECK_RUN"  # the environment variable that marks the processes of one run
_MEGABYTE = 2**20

# Seconds that the watcher may take, after a limit, to kill all and to say so.
_GRACE = 20
# So many times what is kept of the output may be written before the command is ended for it.
_FLOOD = 50


class ConfineError(Exception):
    """The command could not be confined, or its watcher was killed: says what happened."""


@dataclasses.dataclass
class Limits:
    """What a command may use. Sizes are in bytes, times in seconds.

    time: wall time
    cpu: processor time of each process
    memory: of each process (address space), and of all together (resident)
    processes: threads of all processes together
    open_files: of each process
    file_size: of each file that it writes
    disk: of the scratch folder as a whole
    output: what is kept of standard output, and of standard error
    """

    time: float = 120
    cpu: float = 120
    memory: int = 3072 * _MEGABYTE
    processes: int = 400
    open_files: int = 1024
    file_size: int = 256 * _MEGABYTE
    disk: int = 1024 * _MEGABYTE
    output: int = 1 * _MEGABYTE


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

    code: Optional[int]
    ended_by: Optional[str]
    seconds: float
    output: str
    errors: str
    cut: bool
    left: List[str]

    def limit_text(self, limits):
        """Return a sentence that says which limit was broken, or None."""
        said = {
            "time": f"it did not end within {limits.time:.0f} s",
            "memory": f"it used more than {limits.memory // _MEGABYTE} MB of memory",
            "processes": f"it started more than {limits.processes} processes and threads",
            "disk": f"it wrote more than {limits.disk // _MEGABYTE} MB of files",
            "output": f"it printed more than {_FLOOD * limits.output // _MEGABYTE} MB",
        }
        return said.get(self.ended_by)


def environment(scratch, **variables):
    """Return the environment of a confined command, and make the folders that it names.

    It takes over nothing of the user's own. The names in `variables` come on top.
    """
    scratch = pathlib.Path(scratch).resolve()
    env = {
        "PATH": "/usr/bin:/bin:/usr/sbin:/sbin",
        "LANG": "C.UTF-8",
        "LC_ALL": "C.UTF-8",
        "SHELL": "/bin/bash",
        "TERM": "dumb",
        "USER": "student",
        "PYTHONDONTWRITEBYTECODE": "1",
        # ROS 1 has no authentication: nothing listens beyond this machine that need not.
        "ROS_HOSTNAME": "localhost",
    }
    folders = {"HOME": "home", "TMPDIR": "tmp", "ROS_HOME": "ros_home", "ROS_LOG_DIR": "ros_log"}
    for name, folder in folders.items():
        (scratch / folder).mkdir(parents=True, exist_ok=True)
        env[name] = str(scratch / folder)
    return {**env, **variables}


def run(
    command: Sequence[str],
    scratch,
    limits: Optional[Limits] = None,
    env: Optional[dict] = None,
    cwd=None,
    writable: Sequence[str] = (),
    namespaces: Optional[bool] = None,
) -> Result:
    """Run a command to its end, or to the first limit that it breaks.

    scratch: the only folder that it is meant to write to
    env: its whole environment, if not that of environment(scratch)
    cwd: where it starts, if not in scratch
    writable: more folders that it may write to, such as a compiler's cache
    namespaces: False takes the plain way also where namespaces could be made

    Raises ConfineError.
    """
    limits = limits or Limits()
    scratch = os.path.realpath(scratch)
    mark = uuid.uuid4().hex
    env = {**(environment(scratch) if env is None else env), _MARK: mark}
    task = {
        "command": [str(part) for part in command],
        "scratch": scratch,
        "cwd": os.path.realpath(cwd or scratch),
        "env": env,
        "limits": dataclasses.asdict(limits),
        # What lies in the scratch folder is there anyway.
        "protected": [f for f in _needed_folders(env) if not (f + "/").startswith(scratch + "/")],
        "writable": [os.path.realpath(folder) for folder in writable],
    }
    wants_namespaces = namespaces is not False and isolation() == "namespaces"
    # What its /tmp is goes with the run.
    with tempfile.TemporaryDirectory(prefix="tmp_", dir=scratch) as tmp:
        task.update(namespaces=wants_namespaces, tmp=tmp)
        return _run_warden(task, limits, mark)


@functools.lru_cache(maxsize=None)
def isolation():
    """Return "namespaces" or "plain": which of the two ways this user has on this system."""
    with tempfile.TemporaryDirectory(prefix="mrp_check_") as scratch:
        task = {
            "command": ["/bin/true"],
            "scratch": os.path.realpath(scratch),
            "cwd": os.path.realpath(scratch),
            "env": {},
            "limits": dataclasses.asdict(Limits()),
            "protected": [],
            "writable": [],
            "namespaces": True,
            "tmp": os.path.join(os.path.realpath(scratch), "tmp"),
        }
        os.mkdir(task["tmp"])
        try:
            done = _run_warden(task, Limits(time=20), "probe")
        except ConfineError:
            return "plain"
        return "namespaces" if done.code == 0 else "plain"


def _needed_folders(env):
    """Return the folders that a private /tmp must not hide: programs, and this package itself."""
    names = ("PYTHONPATH", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH")
    folders = [folder for name in names for folder in env.get(name, "").split(":") if folder]
    return sorted({os.path.realpath(folder) for folder in [*folders, str(_WARDEN.parents[1])]})


def _run_warden(task, limits, mark):
    task_read, task_write = os.pipe()
    report_read, report_write = os.pipe()
    # Debian's own Python, without the user's settings: the checker's may be anything.
    python = "/usr/bin/python3" if os.access("/usr/bin/python3", os.X_OK) else sys.executable
    try:
        warden = subprocess.Popen(
            [python, "-I", "-S", str(_WARDEN), str(task_read), str(report_write)],
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
    # When the watcher has ended, so has all that it watched over; or else it is ended now.
    reader = _Reader(limits.output, on_report=lambda: _kill_marked(mark))
    try:
        try:
            with os.fdopen(task_write, "w") as file:
                json.dump(task, file)
        except BrokenPipeError:
            pass  # it has ended already: its output says why
        flood = reader.read(
            {warden.stdout: "output", warden.stderr: "errors", report_read: "report"},
            time.monotonic() + limits.time + _GRACE,
        )
        if flood:
            # The end of its standard input tells it to kill all. What it writes goes on to be
            # read, so that it does not stand still at a full pipe.
            warden.stdin.close()
            reader.read(
                {warden.stdout: "output", warden.stderr: "errors", report_read: "report"},
                time.monotonic() + _GRACE,
                flood=False,
            )
    finally:
        warden.stdin.close()
        _end(warden)
        _kill_marked(mark)
        warden.stdout.close()
        warden.stderr.close()
        os.close(report_read)
    return _result(reader, flood)


def _result(reader, flood):
    try:
        report = json.loads(reader.text("report"))
    except ValueError:
        said = reader.text("errors").strip().splitlines()
        raise ConfineError(
            "the process that watches over the package's programs was ended"
            + (f": {said[-1]}" if said else "")
        ) from None
    if not report["all_dead"]:
        raise ConfineError("some processes of the package could not be killed")
    return Result(
        code=report["code"] if report["ended_by"] is None else None,
        ended_by="output" if flood else report["ended_by"],
        seconds=report["seconds"],
        output=reader.text("output"),
        errors=reader.text("errors"),
        cut=reader.cut,
        left=report["left"],
    )


def _end(warden):
    """Wait until the watcher has ended, which the end of its standard input makes it do."""
    try:
        warden.wait(_GRACE)
    except subprocess.TimeoutExpired:
        os.killpg(warden.pid, signal.SIGKILL)
        warden.wait()


def _kill_marked(mark):
    """Kill what bears a run's mark: after its watcher was killed, the only thing to know it by."""
    needle = f"{_MARK}={mark}".encode()
    while True:
        found = [pid for pid in os.listdir("/proc") if pid.isdigit() and _has_mark(pid, needle)]
        for pid in found:
            try:
                os.kill(int(pid), signal.SIGKILL)
            except OSError:
                pass
        if not found:
            return


def _has_mark(pid, needle):
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:
            return needle in file.read().split(b"\0")
    except OSError:
        return False


class _Reader:
    """Reads pipes to their end; keeps of each the first `limit` bytes."""

    def __init__(self, limit, on_report):
        self.limit = limit
        self.on_report = on_report
        self.cut = False
        self._kept = {"output": bytearray(), "errors": bytearray(), "report": bytearray()}
        self._seen = {"output": 0, "errors": 0, "report": 0}
        self._ended = set()

    def text(self, name):
        return self._kept[name].decode("utf-8", errors="replace")

    def read(self, pipes, deadline, flood=True):
        """Read until all have ended, or until the deadline; with `flood`, until there is too much.

        Returns whether there was too much.
        """
        with selectors.DefaultSelector() as selector:
            for pipe, name in pipes.items():
                if name not in self._ended:
                    selector.register(pipe, selectors.EVENT_READ, name)
            while selector.get_map():
                for key, _ in selector.select(max(0, deadline - time.monotonic())):
                    data = os.read(key.fd, 65536)
                    if not data:
                        self._ended.add(key.data)
                        selector.unregister(key.fileobj)
                        if key.data == "report":
                            self.on_report()
                    self._take(key.data, data)
                    if flood and self._seen[key.data] > _FLOOD * self.limit:
                        return True
                if time.monotonic() > deadline:
                    return False
        return False

    def _take(self, name, data):
        self._seen[name] += len(data)
        kept = self._kept[name]
        room = self.limit - len(kept)
        kept += data[: max(0, room)]
        self.cut = self.cut or len(data) > room


def remove(folder):
    """Delete a scratch folder, also where the command took away its own rights to it."""

    def make_writable(function, path, _):
        parent = os.path.dirname(path)
        for one in (parent, path):
            if not os.path.islink(one):
                os.chmod(one, 0o700)
        if os.path.isdir(path) and not os.path.islink(path):
            shutil.rmtree(path, ignore_errors=True)
        else:
            function(path)

    shutil.rmtree(folder, onerror=make_writable)
