# SPDX-License-Identifier: BSD-3-Clause
"""Cold starts: the files of ROS, of Python and of the workspace are on the disk alone.

The kernel is asked to forget them, which takes no root, and slows nothing else down. But what other
programs have in use stays in memory: so whether a start was cold is looked at, too.
"""

import ctypes
import mmap
import os
import pathlib
import re
import resource
import sys
import sysconfig

import numpy

# Of the programs and libraries that a cold start maps, the share that may still be in memory.
_KEPT = 0.05

_LIBC = ctypes.CDLL(None)
_MAPPED = re.compile(r"^\S+ \S+ \S+ \S+ [1-9]\d* +(/.*)$", re.MULTILINE)


def folders(env):
    """Return the folders from which a launch in that environment may read."""
    workspaces = f"{env.get('CMAKE_PREFIX_PATH', '')}:{env.get('ROS_PACKAGE_PATH', '')}".split(":")
    libraries = f"/usr/lib/{sysconfig.get_config_var('MULTIARCH')}"
    ros = [path.parent for path in pathlib.Path("/usr/share").glob("*/package.xml")]
    return [path for path in ["/usr/bin", libraries, *sys.path, *workspaces, *ros] if path]


def forget(paths):
    """Have the kernel forget all files in these folders, as far as it does.

    Returns path -> (bytes that are still in memory, all its bytes).
    """
    os.sync()  # what is not on the disk yet would stay
    files = {}
    for top in paths:
        for folder, _, names in os.walk(top):
            for path in (os.path.join(folder, name) for name in names):
                if os.path.isfile(path):
                    with open(path, "rb") as file:
                        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
                        files[path] = in_memory(file)
    return files


def in_memory(file):
    """Return how many bytes of a file are in memory, and how many it has.

    Of a file that is another user's the kernel says so of all: only root may know.
    """
    size = os.fstat(file.fileno()).st_size
    if not size:
        return 0, 0
    pages = numpy.zeros(-(-size // mmap.PAGESIZE), numpy.uint8)
    with mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ) as mapped:
        content = numpy.frombuffer(mapped, numpy.uint8)
        _LIBC.mincore(
            ctypes.c_void_p(content.ctypes.data),
            ctypes.c_size_t(size),
            ctypes.c_void_p(pages.ctypes.data),
        )
        del content
    return min(size, int((pages & 1).sum()) * mmap.PAGESIZE), size


def kept(files, pids):
    """Return the share that forget() has left in memory of what these processes have mapped.

    What this program has mapped itself, such as Python, is left out: it is in use all the time.
    """
    found = set().union(*map(_mapped, pids)) - _mapped("self")
    left, sizes = numpy.sum([files[path] for path in found if path in files] or [(1, 1)], axis=0)
    return float(left / sizes)


def _mapped(pid):
    return set(_MAPPED.findall(pathlib.Path(f"/proc/{pid}/maps").read_text()))


def read_megabytes():
    """Return what this program's children that have ended, and theirs, have read from the disk."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_inblock * 512 / (1 << 20)


def why_not(starts):
    """Return why starts that should be cold were not, or None; starts: of starts.measure()."""
    share = max(one["kept"] for one in starts)
    if share <= _KEPT:
        return None
    return (
        f"not measured: {share:.0%} of the nodes' programs and libraries were in memory all the "
        "same. Other programs use them; or this was not run by root, who alone may know"
    )
