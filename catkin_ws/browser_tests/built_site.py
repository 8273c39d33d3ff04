# SPDX-License-Identifier: BSD-3-Clause
"""The site that `make docs` has built: its pages, and how to serve it."""

import contextlib
import pathlib
import re
import signal
import subprocess
import sys

# What a shell runs in the background ignores SIGINT, and so would all that is started here; but a
# handler is not inherited.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
SITE = WORKSPACE / "build" / "docs"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
assert PAGES, f"there is no page in {SITE}: run make docs"


def pages_with(text):
    """Return the pages in whose HTML a text is."""
    pages = [page for page in PAGES if text in (SITE / page).read_text()]
    assert pages, f"no page has {text}"
    return pages


@contextlib.contextmanager
def served():
    """Serve the site as `make docs-serve` does, at the address that it prints, until Ctrl-C."""
    command = [sys.executable, WORKSPACE / "tools" / "serve.py", SITE]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            line = server.stdout.readline()
            address = re.fullmatch(r"Open (http://127\.0\.0\.1:\d+/) \(Ctrl-C ends it\)\n", line)
            assert address, line
            yield address.group(1)
            server.send_signal(signal.SIGINT)
            code = server.wait(timeout=60)
            assert code == 0, f"serve.py: exit code {code} after Ctrl-C"
        finally:
            server.kill()
