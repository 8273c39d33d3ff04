# SPDX-License-Identifier: BSD-3-Clause
"""The packages of a workspace, and those of a repository that one of its packages needs."""

from __future__ import annotations

import os
import pathlib

from mrp_check.contract.errors import PackageError
from mrp_check.package.package import BUILT, Package, is_of_tools

_DEEPEST = 4  # folders below a repository's or a workspace's in which a package is looked for
_MOST = 200  # packages


def packages_in(folder: pathlib.Path, deepest: int = _DEEPEST) -> list[pathlib.Path]:
    """Return the folders of the packages in a folder, in order. Raises PackageError."""
    found = []
    for here, folders, files in os.walk(folder):
        depth = len(pathlib.Path(here).relative_to(folder).parts)
        is_built = not BUILT.isdisjoint(files) or "CATKIN_IGNORE" in files
        if "package.xml" in files and not is_built:
            found.append(pathlib.Path(here))
        if "package.xml" in files or is_built or depth >= deepest:
            folders.clear()
        folders[:] = sorted(name for name in folders if not (is_of_tools(name) or name[0] == "."))
        if len(found) > _MOST:
            raise PackageError(f"{folder} has more than {_MOST} packages: expected one workspace.")
    return found


def needed(package: Package) -> list[Package]:
    """Return the packages beside a package that it needs, and those that these need.

    They lie in the same repository; without one, in the same folder.
    """
    above = [*package.root.resolve().parents]
    repository = next((folder for folder in above if (folder / ".git").exists()), None)
    paths = packages_in(repository) if repository else packages_in(above[0], 1)
    others = [Package(path) for path in paths if path != package.root.resolve()]
    known = {other.name: other for other in others if other.name != package.name}
    found: dict[str, Package] = {}
    queue = [package]
    for current in queue:  # it grows
        for name in sorted(_named(current) & known.keys() - found.keys()):
            found[name] = known[name]
            queue.append(known[name])
    return [*found.values()]


def _named(package: Package) -> set[str]:
    """Return the names of the packages that a manifest declares, in whatever it says so."""
    manifest = package.manifest if package.manifest is not None else ()
    tags = (element for element in manifest if element.tag.endswith("depend"))
    return {(element.text or "").strip() for element in tags}
