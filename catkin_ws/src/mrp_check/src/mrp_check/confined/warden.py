# SPDX-License-Identifier: BSD-3-Clause
"""Runs one command, keeps it within limits, and leaves none of its processes behind.

This is the program that confine.py starts: see there. Within namespaces it is their process 1.

Usage: warden.py TASK REPORT    (file descriptors: a Task is read there, an Outcome is written)

When its standard input ends, whatever runs is ended.
"""

import ctypes
import dataclasses
import errno
import os
import pathlib
import resource
import select
import signal
import sys
import time
from typing import Callable, Dict, List, NoReturn, Optional, TypeVar

import psutil

if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from mrp_check.confined import crossing

T = TypeVar("T")
MEGABYTE = 2**20
_LIBC = ctypes.CDLL(None, use_errno=True)

# <sys/prctl.h>
PR_SET_DUMPABLE, PR_CAPBSET_DROP, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 4, 24, 36, 38
# <linux/capability.h>: what root keeps to start and to end what runs as another user, and to read
# its files
KEPT = {"CAP_DAC_OVERRIDE": 1, "CAP_KILL": 5, "CAP_SETGID": 6, "CAP_SETUID": 7}

_TICK = 0.02  # seconds between two looks at what is cheap to look at
_SCAN = 0.2  # the same for the processes' memory and number
_DISK_SCAN = 2.0
_KILLING = 10.0  # seconds in which all must be dead
_CPU_SPARE = 5  # seconds between a limit of processor time that can be ignored, and the last one
_DISK_BLOCK = 512  # bytes, in which st_blocks counts
_SHOWN = 20  # processes that were left and are named
_COMMAND = 400  # characters of a command line that are kept


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
    memory: int = 3072 * MEGABYTE
    processes: int = 400
    open_files: int = 1024
    file_size: int = 256 * MEGABYTE
    disk: int = 1024 * MEGABYTE
    output: int = 1 * MEGABYTE


@dataclasses.dataclass
class Task:
    """What to run, and how; see confine.run().

    env: its whole environment
    user: the id of the user to run it as, or None for this process's own
    namespaces: whether this process is in namespaces of its own
    """

    command: List[str]
    scratch: str
    env: Dict[str, str]
    limits: Limits
    user: Optional[int]
    namespaces: bool
    observes: bool


@dataclasses.dataclass
class Outcome:
    """How it ended, as a confine.Result says; all_dead: whether all that it started has ended."""

    code: Optional[int]
    ended_by: Optional[str]
    seconds: float
    left: List[str]
    all_dead: bool


def descendants() -> List[psutil.Process]:
    """Return all living processes that come from this one, even if they have detached themselves.

    An orphan among them becomes a child of this process, which is a subreaper (or process 1).
    """
    found = psutil.Process().children(recursive=True)
    return [process for process in found if _ask(process.status) not in (None, "zombie", "dead")]


def _ask(question: Callable[[], T]) -> Optional[T]:
    """Return what a process says of itself, or None if it has ended meanwhile."""
    try:
        return question()
    except psutil.Error:
        return None


def command_of(process: psutil.Process) -> str:
    return " ".join(_ask(process.cmdline) or [])[:_COMMAND]


def _reap(codes: Dict[int, int]) -> None:
    """Take in what has ended; note the exit code of each by its id."""
    while True:
        try:
            pid, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if pid == 0:
            return
        if os.WIFSIGNALED(status):
            codes[pid] = -os.WTERMSIG(status)
        else:
            codes[pid] = os.WEXITSTATUS(status)


def kill_all(codes: Dict[int, int]) -> bool:
    """Kill all descendants, also those that come into being meanwhile; return whether all died.

    Their process groups are killed before them: a group cannot fork its way out of a signal that
    goes to all of it at once.
    """
    end = time.monotonic() + _KILLING
    while time.monotonic() < end:
        _reap(codes)
        # What has ended counts until it is reaped: it may have made another one meanwhile, which is
        # not in sight yet, and is of its group.
        found = psutil.Process().children(recursive=True)
        if not found:
            return True
        for process in found:
            try:
                group = os.getpgid(process.pid)
                if group != os.getpgid(0):
                    os.killpg(group, signal.SIGKILL)
                os.kill(process.pid, signal.SIGKILL)
            except OSError:
                pass  # it has ended meanwhile
    return False


def disk_used(folder: str) -> int:
    """Return the bytes that the files under a folder take on disk: very many if it is too deep."""
    used, look_at = 0, [folder]
    while look_at:
        try:
            with os.scandir(look_at.pop()) as entries:
                for entry in entries:
                    try:
                        used += entry.stat(follow_symlinks=False).st_blocks * _DISK_BLOCK
                        if entry.is_dir(follow_symlinks=False):
                            look_at.append(entry.path)
                    except OSError as error:
                        if error.errno == errno.ENAMETOOLONG:  # what lies there cannot be counted
                            return sys.maxsize
        except OSError:
            continue
    return used


def _bound(task: Task) -> None:
    """Set the limits of this process, which is about to become the command."""
    limits = task.limits
    # A user who is new, or one within a namespace, is counted anew; else all of the user's count.
    is_counted_anew = task.namespaces or task.user is not None
    others = 0 if is_counted_anew else int(open("/proc/loadavg").read().split()[3].split("/")[1])
    bounds = {
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_CPU: int(limits.cpu),
        resource.RLIMIT_AS: limits.memory,
        resource.RLIMIT_NOFILE: limits.open_files,
        resource.RLIMIT_FSIZE: limits.file_size,
        resource.RLIMIT_NPROC: limits.processes + others,
    }
    for kind, bound in bounds.items():
        hard = resource.getrlimit(kind)[1]
        # The first CPU limit is a signal that can be ignored, the second cannot.
        later = bound + _CPU_SPARE if kind == resource.RLIMIT_CPU else bound
        allowed = (bound, later)
        if hard != resource.RLIM_INFINITY:
            allowed = (min(bound, hard), min(later, hard))
        resource.setrlimit(kind, allowed)


def _give_up_rights(task: Task) -> None:
    _LIBC.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    if task.user is None:
        return
    if task.observes:
        for capability in set(range(64)) - {*KEPT.values()}:
            _LIBC.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)
        return
    os.setgroups([])
    os.setresgid(*[task.user] * 3)
    os.setresuid(*[task.user] * 3)


def _start(task: Task) -> int:
    """Start the command; return its process id."""
    pid = os.fork()
    if pid:
        return pid
    try:
        os.setsid()
        for name in ("SIGINT", "SIGQUIT", "SIGHUP", "SIGTERM", "SIGPIPE", "SIGXFSZ"):
            signal.signal(getattr(signal, name), signal.SIG_DFL)
        _bound(task)
        _give_up_rights(task)
        null = os.open("/dev/null", os.O_RDONLY)
        os.dup2(null, 0)
        os.closerange(3, 256)
        os.chdir(task.scratch)
        os.execvpe(task.command[0], task.command, task.env)
    except BaseException as error:
        print(f"{task.command[0]} could not be started: {error}", file=sys.stderr, flush=True)
    finally:
        os._exit(127)


def _broken_limit(limits: Limits) -> Optional[str]:
    """Return which limit the processes break together, or None."""
    processes = descendants()
    if sum(_ask(p.num_threads) or 0 for p in processes) > limits.processes:
        return "processes"
    memory = [_ask(p.memory_info) for p in processes]
    return "memory" if sum(m.rss for m in memory if m) > limits.memory else None


def _watch(task: Task) -> Outcome:
    """Run the command to its end, or to the first limit that it breaks; return the report."""
    limits, began = task.limits, time.monotonic()
    folders = [task.scratch, *(["/tmp"] if task.namespaces else [])]
    codes: Dict[int, int] = {}
    main = _start(task)
    # What is written from here on is the command's alone.
    null = os.open("/dev/null", os.O_WRONLY)
    os.dup2(null, 1)
    os.dup2(null, 2)
    next_scan = next_disk_scan = began
    ended_by = None
    while main not in codes and ended_by is None:
        if select.select([0], [], [], _TICK)[0] and not os.read(0, 1):
            ended_by = "caller"
        now = time.monotonic()
        if now - began > limits.time:
            ended_by = "time"
        if now >= next_scan:
            ended_by = ended_by or _broken_limit(limits)
            # Where there is much to look at, look less often.
            next_scan = now + max(_SCAN, 5 * (time.monotonic() - now))
        if now >= next_disk_scan:
            if sum(map(disk_used, folders)) > limits.disk:
                ended_by = "disk"
            next_disk_scan = now + max(_DISK_SCAN, 20 * (time.monotonic() - now))
        _reap(codes)
    seconds = time.monotonic() - began
    left = [] if ended_by else [p for p in descendants() if p.pid != main]
    return Outcome(
        code=codes.get(main),
        ended_by=ended_by,
        seconds=seconds,
        left=[command_of(p) for p in left[:_SHOWN]],
        # With the end of process 1 the kernel ends all of its namespace.
        all_dead=task.namespaces or kill_all(codes),
    )


def main() -> NoReturn:
    with os.fdopen(int(sys.argv[1])) as file:
        task = crossing.from_json(Task, file.read())
    report = int(sys.argv[2])
    # As process 1, a handler would be a way in for signals; and a closed pipe ends nothing here.
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        signal.signal(getattr(signal, name), signal.SIG_DFL)
    _LIBC.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    # What runs as the same user must not look into this process, nor write there.
    _LIBC.prctl(PR_SET_DUMPABLE, 0, 0, 0, 0)
    os.write(report, crossing.to_json(_watch(task)).encode() + b"\n")
    os._exit(0)


if __name__ == "__main__":
    main()
