# SPDX-License-Identifier: BSD-3-Clause
"""Reads what a confined command has written: it may have put anything in the place of a file."""

import os
import pathlib
import stat
from typing import Union

_MOST = 64 * 2**20  # bytes


def read(path: Union[str, pathlib.Path]) -> bytes:
    """Return a file's bytes. Raises OSError if it is a link, a pipe, a device, or too large."""
    fd = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    with os.fdopen(fd, "rb") as file:
        entry = os.fstat(fd)
        if not stat.S_ISREG(entry.st_mode) or entry.st_size > _MOST:
            raise OSError(f"{path} is no file of at most {_MOST} bytes")
        return file.read(_MOST)
