# SPDX-License-Identifier: BSD-3-Clause
"""Reads ROS's own C++ headers, and keeps what clang made of them: usage cpp_headers.py FILE.

Almost all of the time in which a source is read goes into them. So they are read once, while CMake
configures, and for a class once for all. Nothing of a package has a part in it.
"""

import os
import pathlib
import shutil
import subprocess
import sys

if __name__ == "__main__":
    # In place of this file's own folder, whose modules are none of clang's.
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[2])

from mrp_check.confined import variables

STANDARD = "-std=gnu++17"  # the default of g++ 12 and 14
FOLDERS = ("/opt/ros/noetic/include", "/usr/include/xmlrpcpp")
_SOURCE = ("ros.h", "#include <ros/ros.h>\n")


def make(path: pathlib.Path) -> pathlib.Path:
    """Put the headers into the file `path`, and return it. Without clang or ROS there is none."""
    if path.exists():
        return path  # an earlier check has made it
    if os.environ.get(variables.HEADERS):
        shutil.copy(os.environ[variables.HEADERS], path)
    else:
        subprocess.run(["/usr/bin/python3", __file__, str(path)], stderr=subprocess.DEVNULL)
    return path


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
