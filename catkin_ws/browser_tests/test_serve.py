# SPDX-License-Identifier: BSD-3-Clause
"""`make docs-serve`: for this machine alone, until Ctrl-C."""

import pathlib
import urllib.request

from built_site import served

LISTENS = "0A"


def listening(port):
    """Return the addresses at which anything listens at a port, in the kernel's notation."""
    result = set()
    for path in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in pathlib.Path(path).read_text().splitlines()[1:]:
            local, state = line.split()[1], line.split()[3]
            address, hex_port = local.split(":")
            if state == LISTENS and int(hex_port, 16) == port:
                result.add(address)
    return result


def test_it_listens_on_loopback_alone_and_ends_on_ctrl_c():
    with served() as address:
        assert b"<title>" in urllib.request.urlopen(address, timeout=30).read()
        assert listening(int(address.rsplit(":")[-1].strip("/"))) == {"0100007F"}
