# SPDX-License-Identifier: BSD-3-Clause
"""Whether a host is this machine, and whether a ROS master answers: for doctor.py."""

import re
import socket
import xmlrpc.client

DEFAULT_MASTER_URI = "http://localhost:11311"
MASTER_TIMEOUT = 3  # seconds
CONNECT_TIMEOUT = 2  # seconds
UNRESOLVED = "doesn't resolve"


def host_problem(host):
    """Say what is wrong with a host that should be this machine; None if it is.

    As a node of ROS, it listens on all IPv4 addresses, and is called by its name.
    """
    if re.fullmatch(r"0[0-9.]*", host):  # Linux takes it for this machine, and others do not
        return "isn't any machine's address"
    with socket.create_server(("0.0.0.0", 0)) as listener:
        address = host, listener.getsockname()[1]
        try:
            with socket.create_connection(address, CONNECT_TIMEOUT) as caller:
                listener.settimeout(CONNECT_TIMEOUT)
                connection, peer = listener.accept()
                connection.close()
                return None if peer == caller.getsockname() else "is another machine"
        except (socket.gaierror, UnicodeError):
            return UNRESOLVED
        except OSError as error:
            return f"can't be connected to: {error.strerror or error}"


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
