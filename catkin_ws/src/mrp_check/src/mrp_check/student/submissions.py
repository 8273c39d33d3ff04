# SPDX-License-Identifier: BSD-3-Clause
"""A class's folder: which students have handed in something, and which package it is."""

from __future__ import annotations

import os
import pathlib

from mrp_check.contract.errors import PackageError

_ARCHIVES = (".zip", ".tar", ".tgz", ".gz", ".xz", ".bz2", ".7z", ".rar")
_DEEPEST = 3  # folders below a student's own in which the package may be
_MOST_BESIDE = 100  # folders of one folder that are looked into
_MOST_WAITING = 1000  # folders that are still to be looked into


def folders(path):
    """Return the students' folders in a class's folder, and archives. Raises PackageError."""
    path = pathlib.Path(path)
    if not path.is_dir():
        raise PackageError(f"There is no folder {path}: expected one with a folder per student.")
    found = [p for p in sorted(path.iterdir()) if _is_handed_in(p) and not p.name.startswith(".")]
    if not found:
        raise PackageError(f"{path} has no folder in it: expected one for each student.")
    return found


def _is_handed_in(path):
    return path.is_dir() or path.name.endswith(_ARCHIVES)


def package_in(folder):
    """Return the folder of the package that a student has handed in. Raises PackageError."""
    if folder.is_file():
        raise PackageError(f"{folder.name} is an archive: unpack it into a folder.")
    if folder.is_symlink() and folder.resolve().parent != folder.parent.resolve():
        raise PackageError(
            f"{folder.name} is a link out of the class's folder: it is not followed."
            " Copy the package there."
        )
    found = _packages_below(folder)
    if not found:
        raise PackageError(
            f"{folder.name} has no package.xml, down to {_DEEPEST} folders below it:"
            " expected the folder of one package."
        )
    if len(found) > 1:
        names = ", ".join(str(path.relative_to(folder)) for path in found[:4])
        raise PackageError(f"{folder.name} has more than one package: {names}. Expected one.")
    return found[0]


def _packages_below(folder):
    """Return the folders that have a package.xml, the highest first; links are not followed."""
    look_at, found = [(folder, 0)], []
    while look_at and len(look_at) <= _MOST_WAITING:
        here, depth = look_at.pop(0)
        if (here / "package.xml").is_file():
            found.append(here)
        elif depth < _DEEPEST:
            try:
                with os.scandir(here) as entries:
                    below = sorted(e.name for e in entries if e.is_dir(follow_symlinks=False))
            except OSError:
                continue
            below = [name for name in below if not name.startswith(".")]
            look_at += [(here / name, depth + 1) for name in below[:_MOST_BESIDE]]
    return found
