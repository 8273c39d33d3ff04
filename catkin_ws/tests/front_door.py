# SPDX-License-Identifier: BSD-3-Clause
"""make, as a user calls it."""

import os
import subprocess

from mrp_testing import scratch
from mrp_testing.workspace import ROOT


def environment(**variables):
    """Return the environment of a user's shell: not within make, and with a free master's port."""
    env = {k: v for k, v in scratch.environment().items() if not k.startswith("MAKE")}
    env.pop("MFLAGS", None)
    return {**env, **variables}


def make(*arguments, root=ROOT, **variables):
    """Run make in the repository at `root`; return the completed process."""
    return subprocess.run(
        ["make", "-C", str(root), "--no-print-directory", *arguments],
        env=environment(**variables),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def with_other_python(folder):
    """Return a PATH that begins with a python3 that knows no ROS, as pyenv and conda do."""
    other = folder / "python3"
    other.write_text('#!/bin/sh\necho "the wrong python3 was called: $*" >&2\nexit 1\n')
    other.chmod(0o755)
    return str(folder) + ":" + os.environ["PATH"]
