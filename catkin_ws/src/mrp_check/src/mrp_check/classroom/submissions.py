# SPDX-License-Identifier: BSD-3-Clause
"""A class's folder: what each student has handed in, and which package it is."""

from __future__ import annotations

import os
import pathlib
import re

from mrp_check.classroom import archive
from mrp_check.contract.errors import PackageError
from mrp_check.package.package import BUILT, MAX_TEXT, is_of_tools

_DEEPEST = 10  # folders below a student's own in which the package may be
_MOST_ARCHIVES = 10  # in one folder that has no package
_MOST_NESTED = 3  # archives in archives
_NAMED = 4  # in a sentence


def entries(path: str | os.PathLike[str]) -> list[pathlib.Path]:
    """Return all that stands in a class's folder, but for what is hidden. Raises PackageError."""
    path = pathlib.Path(path)
    if not path.is_dir():
        raise PackageError(f"There's no folder {path}: expected one with a folder per student.")
    if (path / "package.xml").is_file():
        raise PackageError(
            f"{path} is a package: expected the folder above it, which has one for each student."
            " To check this one, leave out --class."
        )
    found = [entry for entry in sorted(path.iterdir()) if not _is_hidden(entry.name)]
    if not found:
        raise PackageError(
            f"{path} has nothing in it: expected one folder, or one archive, for each student."
        )
    return found


def archives(entry: pathlib.Path) -> list[pathlib.Path]:
    """Return the archives in which the package must be: none if it lies in a folder, unpacked.

    Raises PackageError if it can be in neither.
    """
    if entry.is_symlink() and entry.resolve().parent != entry.parent.resolve():
        raise PackageError(
            f"{entry.name} is a link out of the class's folder, so it isn't followed. Copy the"
            " package there."
        )
    if not entry.exists():
        raise PackageError(f"There's no {entry.name}.")
    if not entry.is_dir() and not entry.is_file():
        raise PackageError(f"{entry.name} is neither a folder nor a file.")
    packages, packed, _ = _found_in(entry)
    for file in [] if packages else packed:
        archive.refuse_huge(file)
    return [] if packages else packed


def package_in(entry: pathlib.Path, scratch: pathlib.Path, name: str = "") -> pathlib.Path:
    """Return the folder of the package that a student has handed in. Raises PackageError.

    scratch: where archives are unpacked
    name: that of the package, if there are several
    """
    archives(entry)
    found = _packages(entry, entry.name, scratch)
    if len(found) > 1 and name:
        found = {path: place for path, place in found.items() if _is_called(place, name)}
        if not found:
            raise PackageError(f"{entry.name} has more than one package, but none called {name}.")
    if len(found) > 1:
        names = ", ".join([*found][:_NAMED])
        raise PackageError(
            f"{entry.name} has more than one package: {names}."
            " Expected one, or --package NAME, which chooses one."
        )
    return [*found.values()][0]


def _is_called(folder: pathlib.Path, name: str) -> bool:
    with open(folder / "package.xml", encoding="utf-8", errors="replace") as file:
        found = re.search(r"<name>\s*([^<\s]+)\s*</name>", file.read(MAX_TEXT))
    return name in (folder.name, found.group(1) if found else "")


def _packages(
    place: pathlib.Path, name: str, scratch: pathlib.Path, depth: int = 0
) -> dict[str, pathlib.Path]:
    """Return the packages in a folder or an archive, by their paths in it. Raises PackageError.

    name: what the student calls it
    """
    packages, packed, others = _found_in(place)
    found = {str(path.relative_to(place)): path for path in packages}
    problems = [_no_package(name, others)]
    for file in packed[:_MOST_ARCHIVES] if not packages and depth < _MOST_NESTED else []:
        try:
            below = _packages(archive.unpack(file, scratch), file.name, scratch, depth + 1)
        except PackageError as error:
            problems.append(error)
            continue
        within = file.name if place.is_dir() else ""
        found.update(
            {os.path.normpath(os.path.join(within, path)): root for path, root in below.items()}
        )
    if not found:
        raise problems[-1]
    return found


def _no_package(name: str, others: list[str]) -> PackageError:
    seen = f", but {', '.join(others[:_NAMED])}" if others else ""
    return PackageError(
        f"{name} has no package.xml, down to {_DEEPEST} folders below it{seen}:"
        " expected the folder of one package."
    )


def _found_in(
    place: pathlib.Path,
) -> tuple[list[pathlib.Path], list[pathlib.Path], list[str]]:
    """Return the folders with a package.xml, the archives, and the names of other files.

    Links are not followed, and what was built is not looked into.
    """
    if not place.is_dir():
        return [], [place], [place.name]
    packages: list[pathlib.Path] = []
    packed, others = [], []
    for here, folders, files in os.walk(place):
        folder, is_built = pathlib.Path(here), not BUILT.isdisjoint(files)
        if "package.xml" in files:
            packages.append(folder)
        if "package.xml" in files or is_built or len(folder.parts) >= len(place.parts) + _DEEPEST:
            folders.clear()
        folders[:] = sorted(name for name in folders if not _is_hidden(name))
        shown = sorted(name for name in files if not _is_hidden(name)) if not is_built else []
        packed += [folder / name for name in shown if archive.has_its_name(name)]
        others += shown
    return packages, packed, others


def _is_hidden(name: str) -> bool:
    return name.startswith(".") or is_of_tools(name)
