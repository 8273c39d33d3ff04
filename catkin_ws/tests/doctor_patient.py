# SPDX-License-Identifier: BSD-3-Clause
"""A workspace and a shell that are well, for the tests of make doctor to spoil."""

import collections
import contextlib
import json
import os
import re
import shutil
import socket
import socketserver
import subprocess
import threading

from mrp_testing.waiting import DEADLINE
from mrp_testing.workspace import WORKSPACE

DOCTOR = WORKSPACE / "tools" / "doctor.py"
PYTHON = "/usr/bin/python3"
REAL_PATH = "/usr/bin:/bin"

# Runs the doctor with other facts of the machine (lower case) or constants (upper case).
WITH_FACTS = """
import json, sys
sys.path.insert(0, sys.argv[1])
import doctor
import doctor_network
facts = json.loads(sys.argv[2])
for module in (doctor, doctor_network):
    vars(module).update({name: fact for name, fact in facts.items() if name.isupper()})
fields = {name: fact for name, fact in facts.items() if name.islower()}
sys.exit(doctor.examine(doctor.this_machine()._replace(**fields)))
"""

# What the doctor says where all is well.
WELL = {
    "packages": "all 3 of run.txt and tools.txt are installed",
    "CMake": "CMAKE_POLICY_VERSION_MINIMUM is set",
    "python3": "/usr/bin/python3 imports catkin_pkg and rospy",
    "installation": "ROS comes from Debian",
    "localhost": "localhost is this machine",
    "host name": "not in use, because ROS_HOSTNAME is set",
    "ROS_HOSTNAME and ROS_IP": "ROS_HOSTNAME=localhost is this machine",
    "ROS_MASTER_URI": "http://localhost:{port} is on this machine",
    "master's port": "{port} is free",
    "scripts": "every script is executable",
    "build": "setup.bash and both C++ nodes are there",
    "build spaces": "catkin_make built build and devel",
    "log files": "0.0 GB in ~/.ros/log",
    "shell": "devel/setup.bash is sourced",
}
NEEDING_PACKAGES = {
    "python3": "skipped: needs packages",
    "installation": "skipped: needs packages",
    "build": "skipped: needs packages",
    "shell": "skipped: needs build",
}
TAKE_OUT = (
    "open a new terminal; if it's the same there, delete the line from ~/.bashrc"
    " (grep -n setup ~/.bashrc)"
)

LINE = re.compile(r"(\[OK\]   |\[FAIL\] |\[--\]   )([^:]+): (.*)")
FIX = "       fix: "
WHY = "       why:  "
Check = collections.namedtuple("Check", "status text fixes")


class Report:
    """What the doctor printed, and its exit code."""

    def __init__(self, code, output):
        self.code, self.output = code, output
        *lines, self.summary = output.splitlines()
        self.checks = {}  # in the order of printing
        self.why = {}  # title -> the entry of the page why
        title = None
        for line in lines:
            if line.startswith(FIX):
                self.checks[title].fixes.append(line[len(FIX) :])
            elif line.startswith(WHY):
                self.why[title] = re.search(r"\S+://\S+/pages/why.html#(\S+)", line)[1]
            else:
                status, title, text = LINE.fullmatch(line).groups()
                self.checks[title] = Check(status.strip(" []"), text, [])

    def of(self, status):
        """Return title -> text of the checks with that status."""
        return {title: c.text for title, c in self.checks.items() if c.status == status}

    def assert_only_failure(self, title, text, *fixes, skipped=None):
        skipped = skipped or {}
        assert self.checks[title] == Check("FAIL", text, list(fixes)), self.output
        assert self.of("--") == (skipped or {}), self.output
        assert set(self.of("OK")) == set(WELL) - set(skipped) - {title}, self.output
        assert list(self.why) == [title], self.output
        assert (self.summary, self.code) == (f"{len(WELL)} checks, 1 failed", 1), self.output


class Patient:
    """A workspace and an environment in which all is well, for a test to spoil."""

    def __init__(self, folder, port):
        self.folder = folder
        self.workspace = folder / "catkin_ws"
        self.write("apt/run.txt", "# Comment.\nlibc6  # on every Debian\n\nbash|no-such-package\n")
        self.write("apt/tools.txt", "libc6\nno-such-package | dpkg # any one of them\n")
        self.write("src/mrp/package.xml", "<package><name>mrp</name></package>")
        self.write("src/mrp/src/node.py", "#!/usr/bin/env python3\n", mode=0o755)
        self.write("src/mrp/test/module.py", '"""No script."""\n')
        self.write("devel/setup.bash", "")
        self.write("devel/lib/mrp/publisher_cpp_node", "")
        self.write("devel/lib/mrp/subscriber_cpp_node", "")
        self.script = self.workspace / "tools" / "doctor.py"
        self.script.parent.mkdir()
        for part in ("doctor.py", "doctor_network.py", "install_packages.sh"):
            shutil.copy(DOCTOR.with_name(part), self.script.parent)
        parts = ("__init__.py", "releases.py", "contract/__init__.py", "contract/resources.py")
        files = [f"src/mrp_check/{part}" for part in parts]
        for file in (*files, "package.xml", "contracts/pub_sub.yaml"):
            name = f"src/mrp_check/{file}"
            self.write(name, (WORKSPACE / name).read_text())
        # The tests about python3 take the real one; it imports rospy slowly.
        python3 = self.write("stand_in/python3", "#!/bin/sh\nexit 0\n", mode=0o755)
        self.port = port
        self.uri = f"http://localhost:{port}"
        self.env = {
            "PATH": f"{os.path.dirname(python3)}:{REAL_PATH}",
            "HOME": str(folder),
            "CMAKE_POLICY_VERSION_MINIMUM": "3.5",
            "ROS_DISTRO": "Debian",
            "ROS_HOSTNAME": "localhost",
            "ROS_MASTER_URI": self.uri,
            "ROS_PACKAGE_PATH": str(self.workspace / "src"),
            "CMAKE_PREFIX_PATH": str(self.workspace / "devel"),
        }

    def write(self, name, text, mode=0o644):
        """Write a file, by its path from the workspace; return its absolute path."""
        path = self.workspace / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(mode)
        return str(path)

    def examine(self, **facts):
        command = [PYTHON, str(self.script)]
        if facts:
            facts = json.dumps(facts, default=str)
            command = [PYTHON, "-B", "-c", WITH_FACTS, str(self.script.parent), facts]
        run = subprocess.run(
            command, env=self.env, capture_output=True, text=True, timeout=DEADLINE
        )
        assert run.stderr == ""
        return Report(run.returncode, run.stdout)

    def system(self, **fields):
        """Return a file like /etc/os-release, with these fields."""
        text = "".join(f'{name}="{value}"\n' for name, value in fields.items())
        return self.write("os-release", text)

    def noetic(self, name="noetic"):
        """Make ROS Noetic, or ROS One, the one that this shell knows; return the facts for it."""
        (self.folder / "ros" / name).mkdir(parents=True)
        self.env["ROS_DISTRO"] = name
        return {"opt_ros": self.folder / "ros", "dpkg_query": "/no/dpkg-query"}


# Programs that have the master's port; each yields its port.


@contextlib.contextmanager
def serving(server):
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@contextlib.contextmanager
def silent():
    with socket.create_server(("localhost", 0)) as listener:
        yield listener.getsockname()[1]


class _Ssh(socketserver.BaseRequestHandler):
    def handle(self):
        self.request.sendall(b"SSH-2.0-OpenSSH_9.2\r\n")


def talker():
    return serving(socketserver.TCPServer(("localhost", 0), _Ssh))
