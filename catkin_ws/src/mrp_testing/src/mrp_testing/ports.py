# SPDX-License-Identifier: BSD-3-Clause
"""TCP ports of this machine: one that is free, who listens at one, and at which a process does."""

import socket

import psutil

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
    """Return the addresses at which anything listens at a port."""
    return {address.ip for address, _ in _listeners() if address.port == port}


def ports_of(pid):
    """Return the ports at which a process listens, sorted."""
    return sorted({address.port for address, owner in _listeners() if owner == pid})


def _listeners():
    """Return (address, process id) of each TCP socket that listens."""
    sockets = psutil.net_connections("tcp")
    return [(entry.laddr, entry.pid) for entry in sockets if entry.status == psutil.CONN_LISTEN]
