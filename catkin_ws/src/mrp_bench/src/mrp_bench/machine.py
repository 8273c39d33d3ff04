# SPDX-License-Identifier: BSD-3-Clause
"""On what was measured."""

import os
import pathlib
import platform
import re
import subprocess


def describe():
    """Return a dictionary of texts: the processor, the system, and ROS's version."""
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: (.*)$", cpuinfo, re.MULTILINE)
    memory = re.search(r"\d+", pathlib.Path("/proc/meminfo").read_text())
    release = pathlib.Path("/etc/os-release").read_text()
    version = subprocess.run(
        ["rosversion", "roscpp"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ).stdout.strip()
    return {
        "processor": model.group(1) if model else platform.machine(),
        "cores": str(len(os.sched_getaffinity(0))),
        "gigabytes": f"{int(memory.group()) / 1e6:.0f}",
        "system": re.search(r'^PRETTY_NAME="?([^"\n]*)', release, re.MULTILINE).group(1),
        "kernel": platform.release().split("-")[0],
        "python": platform.python_version(),
        "roscpp": version or "unknown",
    }
