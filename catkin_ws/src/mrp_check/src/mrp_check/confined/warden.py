# SPDX-License-Identifier: BSD-3-Clause
"""Runs one command, keeps it within limits, and leaves none of its processes behind.

This is the program that confine.py starts, with the standard library alone: see there.

Standard input: when it ends, whatever runs is ended. The report, one line of JSON, goes to the
file descriptor `report`.
"""

import ctypes
import errno
import json
import os
import resource
import select
import signal
import sys
import time

_LIBC = ctypes.CDLL(None, use_errno=True)

# <sys/prctl.h>
PR_SET_PDEATHSIG, PR_CAPBSET_DROP, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 1, 24, 36, 38
# <sched.h>
CLONE_NEWNS, CLONE_NEWIPC, CLONE_NEWUSER = 0x00020000, 0x08000000, 0x10000000
CLONE_NEWPID, CLONE_NEWNET = 0x20000000, 0x40000000
# <sys/mount.h>, and the system call by its number: glibc has the function from 2.36 on only
MS_NOSUID, MS_NODEV, MS_BIND, MS_REC, MS_PRIVATE = 2, 4, 4096, 16384, 1 << 18
SYS_MOUNT_SETATTR, AT_FDCWD, AT_RECURSIVE, MOUNT_ATTR_RDONLY = 442, -100, 0x8000, 1
# <net/if.h>, <bits/ioctls.h>
SIOCSIFFLAGS, IFF_UP, IFF_RUNNING = 0x8914, 0x1, 0x40

_TICK = 0.02  # seconds between two looks at what is cheap to look at
_SCAN = 0.2  # the same for the processes' memory and number
_DISK_SCAN = 2.0
_KILLING = 10.0  # seconds in which all must be dead


def _call(name, *arguments):
    if getattr(_LIBC, name)(*arguments) < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{name}: {os.strerror(number)}")


# --- Namespaces: the stronger way


def enter_namespaces(scratch, protected, writable, tmp):
    """Go on in namespaces of its own, as their process 1, if the system lets us.

    There, no process outside can be seen or signalled, there is no network but `lo`, and all but
    the scratch folder, /tmp (which is a private one), /dev/shm and `writable` is read-only.

    Returns the id of the child (to the one who waits for it) or 0 (to the child, within).
    Raises OSError if the system does not let us; nothing has changed then but this process.
    """
    flags = CLONE_NEWNS | CLONE_NEWIPC | CLONE_NEWPID | CLONE_NEWNET
    uid, gid = os.getuid(), os.getgid()
    try:
        _call("unshare", flags)
    except OSError:
        _call("unshare", flags | CLONE_NEWUSER)
        _write("/proc/self/setgroups", "deny")
        _write("/proc/self/uid_map", f"{uid} {uid} 1")
        _write("/proc/self/gid_map", f"{gid} {gid} 1")
    ready, tell = os.pipe()
    child = os.fork()
    if child:
        os.close(tell)
        if os.read(ready, 1):
            return child
        os.waitpid(child, 0)
        raise OSError(errno.EPERM, "namespaces cannot be set up")
    os.close(ready)
    # Two things that are right only in process 1: it dies with the one who waits for it, and what
    # it does not handle cannot be sent to it from within.
    _call("prctl", PR_SET_PDEATHSIG, signal.SIGKILL)
    try:
        _set_up_mounts(scratch, protected, writable, tmp)
        _set_up_loopback()
    except OSError:
        os._exit(1)
    os.write(tell, b"1")
    os.close(tell)
    return 0


def _write(path, text):
    with open(path, "w") as file:
        file.write(text)


def _mount(source, target, kind, flags, data=""):
    arguments = (source, target, kind)
    _call("mount", *(a and os.fsencode(a) for a in arguments), flags, os.fsencode(data))


def _bind(source, target):
    _mount(source, target, None, MS_BIND | MS_REC)


class _MountAttr(ctypes.Structure):
    _fields_ = [(n, ctypes.c_uint64) for n in ("attr_set", "attr_clr", "propagation", "userns_fd")]


def _set_read_only(path, read_only):
    attr = _MountAttr(MOUNT_ATTR_RDONLY, 0) if read_only else _MountAttr(0, MOUNT_ATTR_RDONLY)
    _call(
        "syscall",
        SYS_MOUNT_SETATTR,
        AT_FDCWD,
        os.fsencode(path),
        AT_RECURSIVE,
        ctypes.byref(attr),
        ctypes.sizeof(attr),
    )


def _set_up_mounts(scratch, protected, writable, tmp):
    _mount(None, "/", None, MS_REC | MS_PRIVATE)
    # What lies in /tmp and is needed goes into the private /tmp, too: it is opened before that
    # hides it.
    kept = [p for p in [*protected, *writable] if p.startswith("/tmp/") and os.path.isdir(p)]
    opened = [(path, os.open(path, os.O_PATH)) for path in kept]
    if not scratch.startswith("/tmp/"):
        _bind(scratch, scratch)
    scratch_fd = os.open(scratch, os.O_PATH)
    _set_read_only("/", True)
    _bind(tmp, "/tmp")
    _set_read_only("/tmp", False)
    for path, fd in [*opened, (scratch, scratch_fd)]:
        if path.startswith("/tmp/"):
            os.makedirs(path, exist_ok=True)
            _bind(f"/proc/self/fd/{fd}", path)
        os.close(fd)
    for path in protected:
        if path.startswith("/tmp/") and os.path.isdir(path):
            _set_read_only(path, True)
    for path in writable:
        if os.path.isdir(path):
            if not path.startswith("/tmp/"):
                _bind(path, path)
            _set_read_only(path, False)
    _set_read_only(scratch, False)
    _mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, "size=64m,mode=1777")
    _mount("proc", "/proc", "proc", MS_NOSUID | MS_NODEV)


def _set_up_loopback():
    import fcntl
    import socket
    import struct

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        request = struct.pack("16sh22x", b"lo", IFF_UP | IFF_RUNNING)
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, request)


# --- Processes


class Process:
    """What /proc says of a process."""

    def __init__(self, pid):
        self.pid = pid
        with open(f"/proc/{pid}/stat") as file:
            text = file.read()
        # The name, in parentheses, may hold anything.
        fields = text[text.rindex(")") + 2 :].split()
        self.state = fields[0]
        self.parent, self.group = int(fields[1]), int(fields[2])
        self.threads, self.memory = int(fields[17]), int(fields[21]) * resource.getpagesize()

    def command(self):
        try:
            with open(f"/proc/{self.pid}/cmdline", "rb") as file:
                return file.read(400).replace(b"\0", b" ").decode(errors="replace").strip()
        except OSError:
            return ""


def descendants():
    """Return all processes that come from this one, however they have detached themselves.

    An orphan among them becomes a child of this process, which is a subreaper (or process 1).
    """
    children = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                process = Process(int(entry))
            except (OSError, ValueError):
                continue  # it has ended meanwhile
            children.setdefault(process.parent, []).append(process)
    found, look_at = [], [os.getpid()]
    while look_at:
        of_one = children.get(look_at.pop(), [])
        found += of_one
        look_at += [p.pid for p in of_one]
    return found


def _reap(codes):
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


def kill_all(codes):
    """Kill all descendants, also those that come into being meanwhile; return whether all died.

    Their process groups are killed before them: a group cannot fork its way out of a signal that
    goes to all of it at once.
    """
    end = time.monotonic() + _KILLING
    while time.monotonic() < end:
        alive = [p for p in descendants() if p.state not in "ZX"]
        _reap(codes)
        if not alive:
            return True
        own = os.getpgid(0)
        for group in {p.group for p in alive} - {own, 0}:
            _kill(os.killpg, group)
        for process in alive:
            _kill(os.kill, process.pid)
    return False


def _kill(how, number):
    try:
        how(number, signal.SIGKILL)
    except OSError:
        pass  # it has ended meanwhile


def _threads_of_machine():
    with open("/proc/loadavg") as file:
        return int(file.read().split()[3].split("/")[1])


def _watch_first():
    """Be scheduled before what is watched; return whether the system lets us.

    As root, the number of processes is limited only by looking at it, and those that fork without
    end leave little time to look.
    """
    try:
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(0, policy, os.sched_param(1))
    except OSError:
        return False
    return True


def _disk_used(folder):
    """Return the bytes that the files under a folder take on disk."""
    used, look_at = 0, [folder]
    while look_at:
        try:
            with os.scandir(look_at.pop()) as entries:
                for entry in entries:
                    try:
                        used += entry.stat(follow_symlinks=False).st_blocks * 512
                        if entry.is_dir(follow_symlinks=False):
                            look_at.append(entry.path)
                    except OSError:
                        continue
        except OSError:
            continue
    return used


# --- The command


def _start(task, namespaces, is_first):
    """Start the command; return its process id. is_first: what _watch_first() returned."""
    limits = task["limits"]
    pid = os.fork()
    if pid:
        return pid
    try:
        os.setsid()
        for name in ("SIGINT", "SIGQUIT", "SIGHUP", "SIGTERM", "SIGPIPE", "SIGXFSZ"):
            signal.signal(getattr(signal, name), signal.SIG_DFL)
        bounds = {
            resource.RLIMIT_CORE: 0,
            resource.RLIMIT_CPU: int(limits["cpu"]),
            resource.RLIMIT_AS: limits["memory"],
            resource.RLIMIT_NOFILE: limits["open_files"],
            resource.RLIMIT_FSIZE: limits["file_size"],
        }
        if os.getuid():  # the kernel does not hold root to it
            # A namespace counts its own threads; without one, all of the user's count.
            others = 0 if namespaces else _threads_of_machine()
            bounds[resource.RLIMIT_NPROC] = limits["processes"] + others
        elif not is_first:
            os.nice(19)  # as root in a container: the next best thing
        for kind, bound in bounds.items():
            hard = resource.getrlimit(kind)[1]
            bound = bound if hard == resource.RLIM_INFINITY else min(bound, hard)
            # The first CPU limit is a signal that can be ignored, the second cannot.
            later = bound + 5 if kind == resource.RLIMIT_CPU else bound
            later = later if hard == resource.RLIM_INFINITY else min(later, hard)
            resource.setrlimit(kind, (bound, later))
        _call("prctl", PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
        if os.getuid() == 0:
            # Root without a capability: it may change no mount, and signal nobody else's process.
            for capability in range(64):
                _LIBC.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)
        null = os.open("/dev/null", os.O_RDONLY)
        os.dup2(null, 0)
        os.closerange(3, 256)
        os.chdir(task["cwd"])
        os.execvpe(task["command"][0], task["command"], task["env"])
    except BaseException as error:
        print(f"{task['command'][0]} could not be started: {error}", file=sys.stderr, flush=True)
    finally:
        os._exit(127)


def _watch(task, namespaces):
    """Run the command to its end, or to the first limit that it breaks; return the report."""
    is_first = _watch_first()
    limits = task["limits"]
    codes, began = {}, time.monotonic()
    threads_before = _threads_of_machine()
    main = _start(task, namespaces, is_first)
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
        if now - began > limits["time"]:
            ended_by = "time"
        if namespaces and sum(map(str.isdigit, os.listdir("/proc"))) > limits["processes"]:
            ended_by = "processes"  # and no look at each of them, while they become more
        elif now >= next_scan or _threads_of_machine() - threads_before > limits["processes"]:
            next_scan = now + _SCAN
            processes = descendants()
            if sum(p.threads for p in processes) > limits["processes"]:
                ended_by = "processes"
            if sum(p.memory for p in processes) > limits["memory"]:
                ended_by = "memory"
        if now >= next_disk_scan:
            if _disk_used(task["scratch"]) > limits["disk"]:
                ended_by = "disk"
            # Where there is much to look at, look less often.
            next_disk_scan = now + max(_DISK_SCAN, 20 * (time.monotonic() - now))
        _reap(codes)
    seconds = time.monotonic() - began
    left = []
    if ended_by is None:
        left = [p for p in descendants() if p.state not in "ZX" and p.pid != main]
    return {
        "code": codes.get(main),
        "ended_by": ended_by,
        "seconds": seconds,
        "left": [p.command() for p in left[:20]],
        # With the end of process 1 the kernel ends all of its namespace.
        "all_dead": namespaces or kill_all(codes),
    }


def main():
    with os.fdopen(int(sys.argv[1]), closefd=True) as file:
        task = json.load(file)
    report = int(sys.argv[2])
    # As process 1, a handler would be a way in for signals; and a closed pipe ends nothing here.
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        signal.signal(getattr(signal, name), signal.SIG_DFL)
    namespaces = False
    if task["namespaces"]:
        folders = (task["scratch"], task["protected"], task["writable"], task["tmp"])
        try:
            child = enter_namespaces(*folders)
        except OSError:
            return 3  # confine.py then takes the plain way, in a new process
        if child:
            # Within, process 1 watches the same standard input; its end is the end of all.
            os.close(report)
            _, status = os.waitpid(child, 0)
            return 0 if status == 0 else 1
        namespaces = True
    _call("prctl", PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    text = json.dumps(_watch(task, namespaces))
    os.write(report, text.encode() + b"\n")
    os._exit(0)


if __name__ == "__main__":
    sys.exit(main())
