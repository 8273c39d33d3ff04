# SPDX-License-Identifier: BSD-3-Clause
"""Reads ROS's own C++ headers, and keeps what clang made of them: usage cpp_headers.py FILE.

Almost all of the time in which a source is read goes into them. So they are read once, while CMake
configures, and for a class once for all. Nothing of a package has a part in it.
"""

import os
import shutil
import subprocess
import sys

STANDARD = "-std=gnu++17"  # the default of g++ 12 and 14
FOLDERS = ("/opt/ros/noetic/include", "/usr/include/xmlrpcpp")
_SOURCE = ("ros.h", "#include <ros/ros.h>\n")

# Where a class keeps them.
KEPT = "MRP_CHECK_HEADERS"


def make(path):
    """Put the headers into the file `path`, and return it. Without clang or ROS there is none."""
    if os.environ.get(KEPT):
        shutil.copy(os.environ[KEPT], path)
    else:
        subprocess.run(["/usr/bin/python3", __file__, str(path)], stderr=subprocess.DEVNULL)
    return path


def main():
    del sys.path[0]  # this file's folder, whose modules are none of clang's
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
