# SPDX-License-Identifier: BSD-3-Clause
"""A cache of what the tests compile: what one test has compiled, the next one has at once."""

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
        "CCACHE_MAXSIZE": "500M",
    }
