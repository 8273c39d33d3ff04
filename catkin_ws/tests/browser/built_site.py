# SPDX-License-Identifier: BSD-3-Clause
"""The site that `make docs` has built: its pages, and how to serve it."""

import contextlib
import re
import sys

import pytest
from mrp_testing.process import Process
from mrp_testing.workspace import WORKSPACE

SITE = WORKSPACE / "build" / "docs"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
assert PAGES, f"there is no page in {SITE}: run make docs"


def pages_with(text):
    """Return the pages in whose HTML a text is."""
    pages = [page for page in PAGES if text in (SITE / page).read_text()]
    assert pages, f"no page has {text}"
    return pages


def by_page(values):
    """Return the values, pages or tuples that end in one, as parameters of tests.

    Those of a page run in one worker, which need not open it again for each of them.
    """
    return [
        pytest.param(
            value, marks=pytest.mark.xdist_group(value if isinstance(value, str) else value[-1])
        )
        for value in values
    ]


@contextlib.contextmanager
def served():
    """Serve the site as `make docs-serve` does, at the address that it prints, until Ctrl-C."""
    with Process(sys.executable, str(WORKSPACE / "tools" / "serve.py"), str(SITE)) as server:
        server.wait_for(lambda: server.lines, "the address")
        line = re.fullmatch(r"Open (http://127\.0\.0\.1:\d+/) \(Ctrl-C ends it\)", server.lines[0])
        assert line, str(server)
        yield line[1]
        code = server.stop()
        assert code == 0, f"exit code {code} of {server}"
