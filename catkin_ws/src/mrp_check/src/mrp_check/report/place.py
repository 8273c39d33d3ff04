# SPDX-License-Identifier: BSD-3-Clause
"""Where a package is, for a reader who sees the whole repository."""

from __future__ import annotations

import pathlib


def base_of(folder: pathlib.Path) -> pathlib.Path:
    """Return the folder to which a reader's paths are relative, for a package's folder.

    It is the root of the package's repository; else the working folder, if the package is in it;
    else the package's own folder.
    """
    above = (folder, *folder.parents)
    repository = next((parent for parent in above if (parent / ".git").exists()), None)
    working = pathlib.Path.cwd()
    return repository or (working if working in above else folder)
