# SPDX-License-Identifier: BSD-3-Clause
"""Reads ROS's own C++ headers, and keeps what clang made of them: usage cpp_headers.py FILE.

Almost all of the time in which a source is read goes into them. So they are read once, while CMake
configures, and kept in the folder that stays from one check to the next. Checks without such a
folder share them below XDG_CACHE_HOME, if that is set. Nothing of a package has a part in it, and
what runs of one gets a copy.
"""

import contextlib
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

NAME = "ros.pch"  # of the file, in a folder that is given
STANDARD = "-std=gnu++17"  # the default of g++ 12 and 14
FOLDERS = ("/opt/ros/noetic/include", "/usr/include/xmlrpcpp")
_SOURCE = ("ros.h", "#include <ros/ros.h>\n")
# What is different after another version of a package was installed. What differs beside that,
# clang sees for itself: it then reads the headers again.
_INSTALLED = ("/var/lib/dpkg/status", "/opt/ros/noetic/include/ros/ros.h", "/usr/include/ros/ros.h")


def make(path: pathlib.Path) -> pathlib.Path:
    """Put the headers into the file `path`, and return it. Without clang or ROS there is none."""
    if path.exists():
        return path  # an earlier check has made it
    kept = _in_cache()
    for earlier in kept:
        if earlier.exists():
            shutil.copyfile(earlier, path)
            return path
    subprocess.run(["/usr/bin/python3", __file__, str(path)], stderr=subprocess.DEVNULL)
    if path.exists():
        for cached in kept:
            with contextlib.suppress(OSError):  # as where it is read-only
                _keep(path, cached)
    return path


def installed() -> str:
    """Return a text that is another one when other packages are installed."""
    stats = [os.stat(path) for path in _INSTALLED if os.path.exists(path)]
    known = repr([(stat.st_mtime_ns, stat.st_size) for stat in stats])
    return hashlib.sha256(known.encode()).hexdigest()[:16]


def _in_cache() -> list[pathlib.Path]:
    """Return the path at which the headers of what is installed now are shared, if they are."""
    cache = os.environ.get("XDG_CACHE_HOME")
    return [pathlib.Path(cache, "mrp_check", f"ros_{installed()}.pch")] if cache else []


def _keep(path: pathlib.Path, kept: pathlib.Path) -> None:
    """Put a copy of the headers into the cache, in place of earlier ones, whole at every moment."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=kept.parent) as folder:
        shutil.copyfile(path, os.path.join(folder, kept.name))
        for earlier in kept.parent.glob("ros_*.pch"):
            earlier.unlink()
        os.replace(os.path.join(folder, kept.name), kept)


def main() -> None:
    from clang import cindex

    of = cindex.TranslationUnit
    # What the headers' functions do is none of the package's business.
    options = of.PARSE_SKIP_FUNCTION_BODIES | of.PARSE_INCOMPLETE | 0x10  # ForSerialization
    arguments = ["-x", "c++-header", STANDARD, "-w", *(f"-I{path}" for path in FOLDERS)]
    unit = cindex.Index.create().parse(_SOURCE[0], arguments, [_SOURCE], options)
    if not any(diagnostic.severity >= diagnostic.Error for diagnostic in unit.diagnostics):
        unit.save(sys.argv[1])


if __name__ == "__main__":
    main()
