# SPDX-License-Identifier: BSD-3-Clause
"""A cache of what is compiled: what the build or one test has compiled, the next one has at once.

As a program, it prints the variables that `make build` lacks; or nothing, where there is no ccache.
"""

import os
import shutil

from mrp_testing.workspace import WORKSPACE

FOLDER = WORKSPACE / "build" / "ccache"


def variables(folder):
    """Return the environment variables with which CMake builds with the cache, below a folder.

    Paths below the folder count as relative: so what is equal in two folders is compiled once.
    """
    return {
        "CMAKE_CXX_COMPILER_LAUNCHER": "ccache",
        "CCACHE_DIR": str(FOLDER),
        "CCACHE_BASEDIR": str(folder),
        "CCACHE_NOHASHDIR": "1",
        # The compiler says which headers it has read: no other run of it must find out.
        "CCACHE_DEPEND": "1",
        # CI's own, of the first build: what it lets pass has no warning.
        "CCACHE_IGNOREOPTIONS": "-Werror",
        "CCACHE_MAXSIZE": "500M",
    }


if __name__ == "__main__" and shutil.which("ccache"):
    lacking = [pair for pair in variables(WORKSPACE).items() if pair[0] not in os.environ]
    print(*(f"{name}={value}" for name, value in lacking))
