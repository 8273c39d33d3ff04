# SPDX-License-Identifier: BSD-3-Clause
"""Whether a host is this machine, and whether a ROS master answers: for doctor.py."""

import re
import socket
import xmlrpc.client

DEFAULT_MASTER_URI = "http://localhost:11311"
MASTER_TIMEOUT = 3  # seconds
UNRESOLVED = "does not resolve"


def host_problem(host):
    """Say what is wrong with a host that should be this machine; None if it is."""
    try:
        found = socket.getaddrinfo(host, None, socket.AF_INET, socket.SOCK_DGRAM)
    except (OSError, UnicodeError):
        return UNRESOLVED
    for *_, address in found:
        try:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.bind(address)  # only an address of this machine can be bound, or one ...
            if 0 < int(address[0].split(".")[0]) < 224:  # ... that is no machine's
                return None
        except OSError:
            pass
    return "is another machine"


def master(env):
    """Return the master's URI, host and port; no host and port if the URI is malformed."""
    uri = env.get("ROS_MASTER_URI", DEFAULT_MASTER_URI)
    match = re.fullmatch(r"http://([^/:\s]+):([0-9]{1,5})/?", uri)
    if not match or not 0 < int(match.group(2)) < 65536:
        return uri, None, None
    return uri, match.group(1), int(match.group(2))


def master_pid(uri):
    """Return the process id of the ROS master at a URI; None if none answers."""
    socket.setdefaulttimeout(MASTER_TIMEOUT)
    try:
        code, _, pid = xmlrpc.client.ServerProxy(uri).getPid("/doctor")
    except Exception:  # whatever listens there may answer anything
        return None
    return pid if code == 1 else None
