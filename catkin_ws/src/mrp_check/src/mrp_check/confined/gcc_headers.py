# SPDX-License-Identifier: BSD-3-Clause
"""Compiles a C++ source with ROS's headers as g++ has read them before.

Usage: gcc_headers.py COMPILER ARGUMENT...

CMake calls it in place of the compiler (CMAKE_CXX_COMPILER_LAUNCHER). Three quarters of the time in
which a node is compiled go into <ros/ros.h>. So a class or a course has it read once for each set
of flags (building/headers.py). Where the two may differ, the compiler is called as it is.
"""

import hashlib
import os
import re
import subprocess
import sys
from typing import List, Optional, Sequence

FOLDER = "MRP_CHECK_HEADERS"  # variables.py has it, too: this file can import nothing of it
NAME = "ros.h"  # in the folder of its flags, beside what g++ made of it, which it ends in .gch

_COMPILERS = ("c++", "g++")
_TWO_WORDS = ("-o", "-MF", "-MT", "-MQ", "-isystem", "-I")
_NO_PART = ("-c", "-I", "-M", "-DROS_PACKAGE_NAME=")
_FLAG = re.compile(
    r"-(D\w+(=\d+)?|O\w*|W[\w=+-]+|f[\w-]+|g\w*|m[\w=-]+|pedantic|pthread|std=[\w+]+)"
)
# What may stand before #include <ros/ros.h>: headers of C++ and C, and those in folders of
# installed packages, which are the same before it and after.
_BEFORE = re.compile(
    rb"\s+|//[^\n]*|/\*.*?\*/"
    rb"|#[ \t]*include[ \t]*<(?:[a-z_]+|(?:math|signal|std\w+|string|unistd)\.h"
    rb"|(?P<of_package>[\w/]+/\w+\.h(?:pp)?))>",
    re.DOTALL,
)
_ROS = re.compile(rb"#[ \t]*include[ \t]*[<\"]ros/ros\.h[>\"]")
_PLACES = ("/usr/include", "/opt/ros/noetic/include")


def flags(command: List[str]) -> Optional[List[str]]:
    """Return the arguments on which it depends what g++ makes of ROS's headers, or None if that
    cannot be said.

    command: the compiler and its arguments, of which the last one is the source
    """
    kept, skip = [], False
    for word in command[1:-1]:
        if skip or word in _TWO_WORDS:
            skip = not skip
        elif _FLAG.fullmatch(word):
            kept.append(word)
        elif not word.startswith(_NO_PART):
            return None
    is_known = os.path.basename(command[0]) in _COMPILERS and "-c" in command
    return kept if is_known else None


def folder_of(flags: List[str]) -> str:
    """Return what the folder of these flags is called."""
    return hashlib.sha256("\0".join(flags).encode()).hexdigest()[:16]


def begins_with_ros(source: bytes, places: Sequence[str] = _PLACES) -> bool:
    """Return whether all that stands before <ros/ros.h> in a source is as well read after it.

    places: folders of headers that others have written, or a tool
    """
    at = 0
    while not _ROS.match(source, at):
        found = _BEFORE.match(source, at)
        if not found:
            return False
        at, name = found.end(), (found["of_package"] or b"").decode()
        if name and not any(os.path.exists(os.path.join(place, name)) for place in places):
            return False
    return True


def with_headers(command: List[str], folder: str) -> List[str]:
    """Return the command that compiles with the headers in a folder; the same one without them."""
    known = flags(command)
    if known is None:
        return command
    header = os.path.join(folder, folder_of(known), NAME)
    if not os.path.exists(f"{header}.gch"):
        return command
    try:
        with open(command[-1], "rb") as source:
            text = source.read()
    except OSError:
        return command  # the compiler says what is wrong with it
    # Beside what is installed: what catkin makes of the package's own messages.
    made = [word[2:] for word in command if re.fullmatch(r"-I.*/devel/include", word)]
    if not begins_with_ros(text, (*_PLACES, *made)):
        return command
    # The package's name is no part of what was read before: so it is defined after that.
    name = f"{command[command.index('-o') + 1]}.h"
    own = [word for word in command if word.startswith("-DROS_PACKAGE_NAME=")]
    with open(name, "w") as file:
        file.writelines(f"#define ROS_PACKAGE_NAME {word.split('=', 1)[1]}\n" for word in own)
    rest = [word for word in command[1:] if word not in own]
    return [command[0], "-include", header, "-include", name, *rest]


if __name__ == "__main__":
    words = with_headers(sys.argv[1:], os.environ[FOLDER])
    if words != sys.argv[1:]:
        done = subprocess.run(words, stderr=subprocess.PIPE)
        if done.returncode == 0:
            sys.stderr.buffer.write(done.stderr)
            sys.exit()
    # What g++ says of an error with them may not name the source: so it says it without them.
    os.execvp(sys.argv[1], sys.argv[1:])
