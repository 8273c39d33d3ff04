# SPDX-License-Identifier: BSD-3-Clause
"""Opens a file in the student's editor, and a page in the browser."""

from __future__ import annotations

import os
import pathlib
import shlex
import shutil
import subprocess

from mrp_check.contract import resources


def editor() -> list[str]:
    """Return the command of an editor that runs in this terminal; empty if none is chosen."""
    return shlex.split(os.environ.get("VISUAL") or os.environ.get("EDITOR") or "")


def start(*command: str) -> bool:
    """Start a program with a window of its own; return whether there is one."""
    if not shutil.which(command[0]):
        return False
    subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    return True


def page(name: str) -> pathlib.Path:
    """Return the file of a page: as `make docs` built it, or its source.

    name: such as "subscriber"
    """
    workspace = resources.folder("defects").parents[2]
    html = built_page(name)
    return html if html.exists() else workspace / "src/mrp/doc/pages" / f"{name}.rst"


def built_page(name: str) -> pathlib.Path:
    """Return the file of a page that `make docs` builds."""
    return resources.BUILT_SITE / "pages" / f"{name}.html"


def show_page(name: str) -> bool:
    """Open a page in the browser, if there is a desktop; return whether there is one."""
    has_desktop = "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    return has_desktop and start("xdg-open", str(page(name)))
