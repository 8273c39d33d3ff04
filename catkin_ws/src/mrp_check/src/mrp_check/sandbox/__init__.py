# SPDX-License-Identifier: BSD-3-Clause
"""How far this system keeps a command apart, and by which means: bubblewrap, or another user."""

from __future__ import annotations

import atexit
import enum
import functools
import os
import pathlib
import shutil
import stat
import subprocess
import tempfile
import threading
from typing import Iterable

import psutil

from mrp_check.confined import warden

PACKAGE = pathlib.Path(__file__).resolve().parents[1]

# What a command needs of /etc: to find libraries, programs, users, and this machine's own name.
_ETC = (
    "alternatives group hosts ld.so.cache ld.so.conf ld.so.conf.d localtime nsswitch.conf"
    " os-release passwd ros"
).split()
_SHARED_MEMORY = 64 * warden.MEGABYTE
_DEEPEST = 200  # levels of folders: all that root puts there is above
# User ids that systemd, too, gives to what runs for a while; no user of a machine has one.
_IDS = range(61184, 65520)
_HANDING_OVER = threading.Lock()


class ConfineError(Exception):
    """The command could not be confined, or its watcher was killed: says what happened."""


class Isolation(enum.Enum):
    """How far what runs is kept apart, in the words that each report has."""

    NAMESPACES = "The package ran in a sandbox."
    USER = (
        "No sandbox here: the package runs as another user, who can use the network and read what"
        " everybody can read."
    )
    NONE = "No sandbox here: the package runs with your permissions. Only check code you trust."


def isolation() -> Isolation:
    """Return the Isolation that this user has on this system."""
    if bubblewraps_error() is None:
        return Isolation.NAMESPACES
    return Isolation.NONE if os.getuid() else Isolation.USER


def isolation_text(tools: str = "") -> str:
    """Return what the Isolation is, and what bubblewrap says where it makes no sandbox.

    tools: what has run, if no node of the package has
    """
    error = bubblewraps_error()
    if tools and not error:
        return f"No node ran; {tools} did, in a sandbox."
    return " ".join(filter(None, [isolation().value, error]))


@functools.lru_cache(maxsize=None)
def bubblewraps_error() -> str | None:
    """Try bubblewrap; return its first line if it fails, or None."""
    command = [*bubblewrap([]), "/bin/true"]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True)
    except FileNotFoundError:
        return "bubblewrap is not installed."
    lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
    return (lines or [f"bwrap: exit code {done.returncode}"])[0] if done.returncode else None


def bubblewrap(binds: Iterable[tuple[str, str, str]]) -> list[str]:
    """Return bwrap and its options; binds: of more files, (option, path outside, path within)."""
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
        options += [word for name in warden.KEPT for word in ("--cap-add", name)]
    options += ["--perms", "1777", "--size", str(_SHARED_MEMORY), "--tmpfs", "/dev/shm"]
    for option, outside, within in binds:
        for parent in reversed(pathlib.Path(within).parents):
            options += ["--perms", "0755", "--dir", str(parent)]
        options += [option, outside, within]
    return ["bwrap", *options, "--remount-ro", "/", "--"]


def hand_over(scratch: str) -> int | None:
    """Give to the owner of the scratch folder what root has put there; return the owner's id.

    The first time, the owner is a new one, whom no process belongs to. Another user than root has
    nothing to give away: None. Raises ConfineError.
    """
    if os.getuid():
        return None
    with _HANDING_OVER:
        owner = os.stat(scratch).st_uid
        if owner == 0:
            owner = _new_owner(scratch)
    # By file descriptors: what runs at the same time may put links in the way.
    for path, folders, files, fd in os.fwalk(scratch):
        for name in (*folders, *files):
            entry = os.stat(name, dir_fd=fd, follow_symlinks=False)
            # A file with two names may be one of root's own, elsewhere.
            if entry.st_uid == 0 and (entry.st_nlink == 1 or name in folders):
                os.chown(name, owner, owner, dir_fd=fd, follow_symlinks=False)
        if path.count(os.sep) > _DEEPEST:
            folders.clear()
    return owner


def _new_owner(folder: str) -> int:
    """Give a folder to a user whom no process belongs to; return the id. Raises ConfineError."""
    # What is asked of each at once: by now it may have ended.
    known = [process.info["uids"] for process in psutil.process_iter(["uids"])]
    used = {uids.real for uids in known if uids}
    free = [id_ for id_ in _IDS if id_ not in used]
    owner = free[os.getpid() % len(free)]
    try:
        os.chown(folder, owner, owner)
    except PermissionError:
        raise ConfineError(
            "root runs the package's programs as another user. For this it needs the"
            " capabilities CHOWN, DAC_OVERRIDE, KILL, SETGID and SETUID, and it lacks some"
            " of them here. Add them, or run the checker as a user who is not root"
        ) from None
    return owner


def reaches(folder: str) -> bool:
    """Return whether a command that may use a folder outside of its scratch folder can enter it.

    With namespaces the folder is bound into them; for another user its whole path must be open.
    """
    if isolation() is not Isolation.USER:
        return True
    parents = pathlib.Path(os.path.realpath(folder)).parents
    return all(parent.stat().st_mode & stat.S_IXOTH for parent in parents if parent.exists())


def code() -> pathlib.Path:
    """Return the folder `confined`, as a command can read it: a home of root's may be closed."""
    return copied_code() if isolation() is Isolation.USER else PACKAGE / "confined"


@functools.lru_cache(maxsize=None)
def copied_code() -> pathlib.Path:
    """Copy the folder `confined`, and return the copy: it is deleted with this process's end."""
    folder = tempfile.mkdtemp(prefix="mrp_check_code_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.chmod(folder, 0o755)
    package = pathlib.Path(folder, PACKAGE.name)
    shutil.copytree(PACKAGE / "confined", package / "confined")
    shutil.copy(PACKAGE / "__init__.py", package)  # some of these programs import others of them
    return package / "confined"
