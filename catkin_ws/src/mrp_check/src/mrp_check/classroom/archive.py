# SPDX-License-Identifier: BSD-3-Clause
"""What is packed: a zip, a tar, a git bundle, ... unpacked in a sandbox, within limits."""

from __future__ import annotations

import pathlib
import re
import shutil
import tempfile

from mrp_check import sandbox
from mrp_check.confined import warden
from mrp_check.contract.errors import PackageError
from mrp_check.package.package import is_of_tools
from mrp_check.sandbox import confine

_MEGABYTE = 10**6
_MOST_PACKED = 1000 * _MEGABYTE  # of one archive
_MOST_UNPACKED = 1000 * _MEGABYTE  # of one submission, with the archives in its archives
_SECONDS = 120

_NAMES = re.compile(
    r"\.(zip|tar|tgz|tbz2?|txz|(tar\.)?(gz|bz2|xz|zst)|bundle|7z|rar)$", re.IGNORECASE
)


def has_its_name(name: str) -> bool:
    """Return whether a file is called like an archive."""
    return bool(_NAMES.search(name)) and not is_of_tools(name)


def unpack(path: pathlib.Path, scratch: pathlib.Path) -> pathlib.Path:
    """Unpack an archive into a new folder, and return that. Raises PackageError.

    scratch: of the submission
    """
    refuse_huge(path)
    room = _MOST_UNPACKED - warden.disk_used(str(scratch))
    own = pathlib.Path(tempfile.mkdtemp(dir=scratch))
    # The folder is called like the package, mostly: a rule asks for it.
    folder = own / "files" / (path.name.split(".")[0] or "package")
    folder.mkdir(parents=True)
    shutil.copyfile(path, own / "given")
    disk = max(room, 0) + path.stat().st_size
    limits = confine.Limits(time=_SECONDS, file_size=_MOST_UNPACKED, disk=disk)
    program = sandbox.code() / "unpack.py"
    command = ["/usr/bin/python3", "-I", program, own / "given", folder]
    try:
        done = confine.run(command, own, limits)
    except confine.ConfineError as error:
        raise PackageError(f"{path.name} can't be unpacked: {error}.") from None
    if done.code != 0:
        reason = done.limit_text(limits) or (done.errors.strip().splitlines() or ["nothing"])[-1]
        raise PackageError(
            f"{path.name} can't be unpacked: {reason}. Expected a zip, a tar, a tar.gz or a git"
            " bundle of the package, with little else in it."
        )
    return folder


def refuse_huge(path: pathlib.Path) -> None:
    """Raise PackageError if an archive is too large to be read at all."""
    size = path.stat().st_size
    if size > _MOST_PACKED:
        raise PackageError(
            f"{path.name} has {size // _MEGABYTE} MB: more than {_MOST_PACKED // _MEGABYTE} MB"
            " aren't read. Hand in only the package."
        )
