# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial's container, which `make docker-build DEBIAN=bookworm` builds."""

import shutil
import subprocess

IMAGE = "mrp:bookworm"

# As `make docker-run` does; but without its name, which another one may have.
COMMAND = ["docker", "run", "--rm", "--network", "none", IMAGE]


def why_not():
    """Return why no container can be started here, or None."""
    if not shutil.which("docker"):
        return "not measured: Docker is not installed"
    if not _succeeds("docker", "info"):
        return "not measured: no Docker engine answers"
    if not _succeeds("docker", "image", "inspect", IMAGE):
        return f"not measured: there is no image {IMAGE}: make docker-build DEBIAN=bookworm"
    return None


def _succeeds(*command):
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return done.returncode == 0
