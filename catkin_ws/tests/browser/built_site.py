# SPDX-License-Identifier: BSD-3-Clause
"""The site that `make docs` has built: its pages, and how to serve it."""

import contextlib
import re
import sys

from mrp_testing.process import Process
from mrp_testing.workspace import WORKSPACE

SITE = WORKSPACE / "build" / "docs"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
assert PAGES, f"there is no page in {SITE}: run make docs"


def with_each_kind():
    """Return short pages that together have each kind of thing to press, known by its class."""
    found = {}
    for page in sorted(PAGES, key=lambda page: (SITE / page).stat().st_size):
        text = (SITE / page).read_text()
        for tag in re.findall("<(?:a|button|input|label|summary)[ >][^>]*", text):
            kind = tag.split()[0], *re.findall('class="([^"]*)"', tag)
            found.setdefault(kind, page)
    return sorted({*found.values()})


@contextlib.contextmanager
def served():
    """Serve the site as `make docs-serve` does, at the address that it prints, until Ctrl-C."""
    command = ("-u", "-m", "http.server", "--bind", "127.0.0.1", "--directory", str(SITE), "0")
    with Process(sys.executable, *command) as server:
        server.wait_for(lambda: server.lines, "the address")
        line = re.search(r"\((http://127\.0\.0\.1:\d+/)\)", server.lines[0])
        assert line, str(server)
        yield line[1]
        code = server.stop()
        assert code == 0, f"exit code {code} of {server}"
