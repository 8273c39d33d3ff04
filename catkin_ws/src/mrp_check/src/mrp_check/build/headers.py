# SPDX-License-Identifier: BSD-3-Clause
"""Has g++ read ROS's headers once for a class or a course, and not for each source again."""

from __future__ import annotations

import os
import pathlib
import shutil
from typing import Iterable

from mrp_check import sandbox
from mrp_check.confined import cpp_headers, gcc_headers, variables
from mrp_check.sandbox import confine
from mrp_check.sandbox.scratch import scratch_folder

_MOST = 3  # sets of flags: each takes 200 MB
_BEGIN = '#define ROS_PACKAGE_NAME "ros"\n#include <ros/ros.h>\n#undef ROS_PACKAGE_NAME\n'


def folder() -> pathlib.Path | None:
    """Return the folder in which they are kept, if there is one."""
    kept = os.environ.get(variables.HEADERS)
    return pathlib.Path(kept) if kept else None


def launcher() -> str:
    """Return what CMake is to call in place of the compiler, with ; between its words."""
    # -I and -S: nothing of Python's own is needed.
    return ";".join(("/usr/bin/python3", "-I", "-S", str(sandbox.code() / "gcc_headers.py")))


def missing(commands: Iterable[list[str]]) -> list[str] | None:
    """Return the flags for which they are made now, if any: those of the first of some compilers'
    commands. Nobody else makes them then."""
    kept, command = folder(), next(iter(commands), None)
    flags = gcc_headers.flags(command) if kept and command else None
    if not kept or flags is None:
        return None
    of_flags = kept / gcc_headers.folder_of(flags)
    if len([path for path in kept.iterdir() if path.is_dir()]) >= _MOST:
        return None
    try:
        of_flags.mkdir(mode=0o755)
    except FileExistsError:  # they are there, or another check makes them
        return None
    return flags


def make(flags: list[str]) -> None:
    """Make them, confined: it takes seconds, and flags are a package's own."""
    kept = folder()
    assert kept
    of_flags, made = kept / gcc_headers.folder_of(flags), f"{gcc_headers.NAME}.gch"
    (of_flags / gcc_headers.NAME).write_text(_BEGIN)
    include = [f"-I{path}" for path in cpp_headers.FOLDERS]
    with scratch_folder() as scratch:
        (scratch / gcc_headers.NAME).write_text(_BEGIN)
        command = ["g++", *flags, *include, "-x", "c++-header", gcc_headers.NAME, "-o", made]
        result = confine.run(command, scratch)
        if result.code == 0:
            # A copy: what the command has written is its user's.
            shutil.copyfile(scratch / made, of_flags / "new")
            os.replace(of_flags / "new", of_flags / made)
