# SPDX-License-Identifier: BSD-3-Clause
"""`make docs-serve`: for this machine alone, until Ctrl-C."""

import urllib.request

from built_site import served
from mrp_testing.ports import listening


def test_it_listens_on_loopback_alone_and_ends_on_ctrl_c():
    with served() as address:
        assert b"<title>" in urllib.request.urlopen(address, timeout=30).read()
        assert listening(int(address.rsplit(":")[-1].strip("/"))) == {"0100007F"}
