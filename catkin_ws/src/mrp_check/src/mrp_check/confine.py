# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command that is not trusted: within limits, and with nothing of it left afterwards.

Always, as any user:
- the command has a session and a process group, and a HOME, TMPDIR, ROS_HOME and ROS_LOG_DIR of its
  own, in a scratch folder;
- it is ended when it breaks a limit: see Limits;
- its output is read to the end, and kept up to a limit;
- every process that it started is killed when it ends, even if it has detached itself: a watching
  process (confined/warden.py) adopts all orphans.

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

import atexit
import contextlib
import dataclasses
import enum
import functools
import json
import os
import pathlib
import selectors
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import uuid
from typing import List, Optional, Sequence

import psutil

from mrp_check.confined import apart

_HERE = pathlib.Path(__file__).resolve().parent
_MARK = "MRP_CHECK_RUN"  # the environment variable that marks the processes of one run
_MEGABYTE = 2**20

# What a command needs of /etc: to find libraries, programs, users, and this machine's own name.
_ETC = ("alternatives", "group", "hosts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "localtime")
_ETC += ("nsswitch.conf", "os-release", "passwd", "ros")
# User ids that systemd, too, gives to what runs for a while; no user of a machine has one.
_IDS = range(61184, 65520)
_HANDING_OVER = threading.Lock()
_RUNNING = set()  # the watchers of all runs
# With these, root starts and ends what runs as another user, and reads its files.
_CAPABILITIES = ("CAP_DAC_OVERRIDE", "CAP_KILL", "CAP_SETGID", "CAP_SETUID")

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
    return {**env, **folders(scratch), **variables}


def folders(scratch):
    """Return the variables that name a command's own folders, and make these."""
    names = {"HOME": "home", "TMPDIR": "tmp", "ROS_HOME": "ros_home", "ROS_LOG_DIR": "ros_log"}
    made = {name: pathlib.Path(scratch).resolve() / folder for name, folder in names.items()}
    for folder in made.values():
        folder.mkdir(parents=True, exist_ok=True)
    return {name: str(folder) for name, folder in made.items()}


class Isolation(enum.Enum):
    """How far what runs is kept apart. The text says what does not hold, as a sentence's end."""

    NAMESPACES = ""
    USER = (
        "this system makes no namespaces. The package's programs run as another user, who can use"
        " the network and read what all users can read"
    )
    NONE = (
        "this system makes no namespaces. The package's programs run as you: they can read and"
        " change your files, and this verdict. Check only what you trust, or use the container"
    )


@functools.lru_cache(maxsize=None)
def isolation():
    """Return the Isolation that this user has on this system."""
    command = [*_bubblewrap([]), "/bin/true"]
    with contextlib.suppress(FileNotFoundError):  # bubblewrap may not be installed
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True)
        if done.returncode == 0:
            return Isolation.NAMESPACES
    return Isolation.NONE if os.getuid() else Isolation.USER


def run(
    command: Sequence[str],
    scratch,
    limits: Optional[Limits] = None,
    env: Optional[dict] = None,
    cwd=None,
    readable: Sequence[str] = (),
    writable: Sequence[str] = (),
    namespaces: bool = True,
    observes: bool = False,
) -> Result:
    """Run a command to its end, or to the first limit that it breaks.

    scratch: the only folder that it is meant to write to
    env: its whole environment, if not that of environment(scratch)
    cwd: where it starts, if not in scratch
    readable: more folders that it may read
    writable: more folders that it may write to, such as a compiler's cache
    namespaces: False makes none, even where they could be made
    observes: it is the checker's own, and starts what is not trusted as confined/apart.py says

    Raises ConfineError.
    """
    limits = limits or Limits()
    scratch = os.path.realpath(scratch)
    mark = uuid.uuid4().hex
    env = {**(environment(scratch) if env is None else env), _MARK: mark}
    namespaces = namespaces and isolation() is Isolation.NAMESPACES
    # Its /tmp goes with the run. It lies beside the scratch folder: nothing in that is safe to use.
    with tempfile.TemporaryDirectory(prefix="tmp_", dir=os.path.dirname(scratch)) as tmp:
        os.chmod(tmp, 0o1777)
        task = {
            "command": [str(part) for part in command],
            "folders": [scratch, "/tmp"] if namespaces else [scratch],
            "cwd": os.path.realpath(cwd or scratch),
            "env": env,
            "limits": dataclasses.asdict(limits),
            "user": _hand_over(scratch),
            "namespaces": namespaces,
            "observes": observes,
        }
        if observes:
            env[apart.VARIABLE] = json.dumps({key: task[key] for key in ("user", "namespaces")})
        binds = [("--bind", tmp, "/tmp")]
        for option, paths in (("--ro-bind", [_HERE, *readable]), ("--bind", [scratch, *writable])):
            binds += [(option, path, path) for path in map(os.path.realpath, paths)]
        if namespaces:
            return _run_warden(_bubblewrap(binds), task, limits, mark=None)
        return _run_warden([], task, limits, mark=mark if task["user"] is None else None)


@functools.lru_cache(maxsize=None)
def code():
    """Return the folder `confined`, as a command can read it: a home of root's may be closed."""
    if isolation() is not Isolation.USER:
        return _HERE / "confined"
    folder = tempfile.mkdtemp(prefix="mrp_check_code_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.chmod(folder, 0o755)
    package = pathlib.Path(folder, _HERE.name)
    shutil.copytree(_HERE / "confined", package / "confined")
    shutil.copy(_HERE / "__init__.py", package)  # some of these programs import others of them
    return package / "confined"


def stop():
    """End all that runs at this moment; each run() returns then."""
    for warden in list(_RUNNING):
        warden.stdin.close()


def _bubblewrap(binds):
    """Return bwrap and its options; binds: of more files (option, path outside, path within)."""
    options = ["--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--as-pid-1"]
    options += ["--die-with-parent", "--cap-drop", "ALL"]
    for path in ("/bin", "/sbin", "/lib", "/lib32", "/lib64", "/libx32"):
        if os.path.islink(path):
            options += ["--symlink", os.readlink(path), path]
        else:
            options += ["--ro-bind-try", path, path]
    pythons = [path.name for path in pathlib.Path("/etc").glob("python3*")]
    for path in ("/etc", "/opt", "/run", "/home", "/root", "/var"):
        options += ["--perms", "0755", "--dir", path]
    for path in ("/usr", "/opt/ros", *(f"/etc/{name}" for name in (*_ETC, *pythons))):
        options += ["--ro-bind-try", path, path]
    options += ["--proc", "/proc", "--dev", "/dev"]
    if os.getuid():
        options += ["--unshare-user"]
    else:
        # To others the kernel's settings are read-only anyway; and they make a /proc within this.
        options += ["--ro-bind", "/proc/sys", "/proc/sys"]
        options += [word for name in _CAPABILITIES for word in ("--cap-add", name)]
    options += ["--perms", "1777", "--size", str(64 * _MEGABYTE), "--tmpfs", "/dev/shm"]
    for option, outside, within in binds:
        for parent in reversed(pathlib.Path(within).parents):
            options += ["--perms", "0755", "--dir", str(parent)]
        options += [option, str(outside), str(within)]
    return ["bwrap", *options, "--remount-ro", "/", "--"]


def _hand_over(scratch):
    """Give to the owner of the scratch folder what root has put there; return the owner's id.

    The first time, the owner is a new one, whom no process belongs to. Another user than root has
    nothing to give away: None. Raises ConfineError.
    """
    if os.getuid():
        return None
    with _HANDING_OVER:
        owner = os.stat(scratch).st_uid
        if owner == 0:
            used = {process.uids().real for process in psutil.process_iter(["uids"])}
            free = [id_ for id_ in _IDS if id_ not in used]
            owner = free[os.getpid() % len(free)]
            try:
                os.chown(scratch, owner, owner)
            except PermissionError:
                raise ConfineError(
                    "root runs the package's programs as another user. For this it needs the"
                    " capabilities CHOWN, DAC_OVERRIDE, KILL, SETGID and SETUID, and it lacks some"
                    " of them here. Add them, or run the checker as a user who is not root"
                ) from None
    # By file descriptors: what runs at the same time may put links in the way.
    for _, folders, files, fd in os.fwalk(scratch):
        for name in (*folders, *files):
            entry = os.stat(name, dir_fd=fd, follow_symlinks=False)
            # A file with two names may be one of root's own, elsewhere.
            if entry.st_uid == 0 and (entry.st_nlink == 1 or name in folders):
                os.chown(name, owner, owner, dir_fd=fd, follow_symlinks=False)
    return owner


def _run_warden(sandbox, task, limits, mark):
    task_read, task_write = os.pipe()
    report_read, report_write = os.pipe()
    # Debian's own Python, without the user's settings: the checker's may be anything.
    warden_py = [*sandbox, "/usr/bin/python3", "-I", str(_HERE / "confined" / "warden.py")]
    try:
        warden = subprocess.Popen(
            [*warden_py, str(task_read), str(report_write)],
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
    _RUNNING.add(warden)
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
        _RUNNING.discard(warden)
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
    """Kill what bears a run's mark: after its watcher was killed, the only thing to know it by.

    mark: None where they could not have killed it
    """
    while mark:
        found = [process for process in psutil.process_iter() if _has_mark(process, mark)]
        for process in found:
            with contextlib.suppress(psutil.Error):
                process.kill()
        if not found:
            return


def _has_mark(process, mark):
    try:
        return process.environ().get(_MARK) == mark
    except psutil.Error:
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
