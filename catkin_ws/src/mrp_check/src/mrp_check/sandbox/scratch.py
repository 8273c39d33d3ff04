# SPDX-License-Identifier: BSD-3-Clause
"""The folders in which packages are copied, built and run: one for each check, or one that stays.

A student checks the same package again and again. So what was built last is kept, in one folder
for each user, and what has not changed since then is not built again.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import pathlib
import shutil
import stat
import tempfile
from typing import Iterator

from mrp_check.confined import cpp_headers
from mrp_check.sandbox import confine

_OPEN = 0o711  # for the user that the package's programs run as
_LEAST = 2**30  # bytes that must be free: what stays must not fill a disk


@contextlib.contextmanager
def scratch_folder() -> Iterator[pathlib.Path]:
    """Make a folder for checks, and delete it in the end."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="mrp_check_"))
    folder.chmod(_OPEN)
    try:
        yield folder
    finally:
        confine.remove(folder)


@contextlib.contextmanager
def kept_folder(version: str) -> Iterator[pathlib.Path]:
    """Yield this user's folder that stays, or one that does not, if another check has it now.

    version: a text that is another one in each version of the checker: what one has built, no
        other one trusts
    """
    folder = pathlib.Path(tempfile.gettempdir(), f"mrp_check.{os.getuid()}")
    with contextlib.ExitStack() as stack:
        if _is_own(folder) and _is_locked(stack, folder):
            of = f"{version} {cpp_headers.installed()}"
            known = folder / "of"
            if not known.exists() or known.read_text() != of:
                _empty(folder)
                known.write_text(of)
            try:
                yield folder
            except BaseException:  # such as Ctrl-C: of what was stopped, nothing stays
                _empty(folder)
                raise
        else:
            yield stack.enter_context(scratch_folder())


def _is_own(folder: pathlib.Path) -> bool:
    """Make the folder, if it is not there. Return whether nobody else can change it."""
    with contextlib.suppress(FileExistsError):
        folder.mkdir(mode=_OPEN)
    found = folder.lstat()
    is_own = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid()
    return is_own and not found.st_mode & 0o022 and shutil.disk_usage(folder).free > _LEAST


def _is_locked(stack: contextlib.ExitStack, folder: pathlib.Path) -> bool:
    """Take the folder until the stack is left; return whether no other check has it."""
    fd = os.open(folder, os.O_RDONLY)
    stack.callback(os.close, fd)
    try:
        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _empty(folder: pathlib.Path) -> None:
    for path in folder.iterdir():
        if path.is_dir() and not path.is_symlink():
            confine.remove(path)
        else:
            path.unlink()
