# SPDX-License-Identifier: BSD-3-Clause
"""TCP ports of this machine: one that is free, who listens at one, and at which a process does."""

import contextlib
import os
import pathlib
import socket

_LISTENS = "0A"  # the state in the kernel's table: see proc(5)


_kept = []


def free_port():
    """Return a port on which nothing listens, for a master.

    It stays bound until this process ends. A port that is bound, but not listened to, is given to
    no other program that asks for any port, as nodes do; who asks for this one may have it, if it
    sets SO_REUSEADDR, as Python's servers do (see socket(7)).
    """
    probe = socket.socket()
    probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    probe.bind(("localhost", 0))
    _kept.append(probe)
    return probe.getsockname()[1]


def listening(port):
    """Return the addresses at which anything listens at a port, in the kernel's notation."""
    return {address for address, number, _ in _listeners() if number == port}


def ports_of(pid):
    """Return the ports at which a process listens, sorted."""
    files = []
    for descriptor in pathlib.Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # the process has closed it just now
            files.append(os.readlink(descriptor))
    return sorted({number for _, number, inode in _listeners() if f"socket:[{inode}]" in files})


def _listeners():
    """Yield (address, port, inode) of each socket that listens."""
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in pathlib.Path(table).read_text().splitlines()[1:]:
            fields = line.split()
            address, number = fields[1].split(":")
            if fields[3] == _LISTENS:
                yield address, int(number, 16), fields[9]
