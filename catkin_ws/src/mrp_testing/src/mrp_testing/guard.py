# SPDX-License-Identifier: BSD-3-Clause
"""A plugin of pytest that keeps tests from this machine's package manager, sudo and containers.

Programs that refuse come first on PATH: each notes that it was called, and exits with 97; then the
test that called it fails. A test puts its own stand-ins before these: one of sudo, too, as the real
one looks for programs in a PATH of its own. The Makefile puts /usr/bin before PATH, so it reads
from MRP_TEST_GUARD where these programs are. MRP_TEST_ENGINE gives the tests this machine's Docker
engine: `make docker-containers` sets it. The home stays as it is: ROS and ccache write elsewhere.
"""

import os
import pathlib
import shutil
import tempfile

import pytest

PACKAGES = ("apt", "apt-get", "dpkg", "su", "sudo")
ENGINES = ("docker", "docker-compose", "podman")

# dpkg may say what is there: compilers and CMake ask it for the machine's architecture.
_REFUSE = """\
#!/bin/sh
name=${0##*/}
case "$name $1" in
  dpkg\\ --print-* | dpkg\\ --compare-versions | dpkg\\ -[lLsS] | dpkg\\ --version)
    exec /usr/bin/dpkg "$@" ;;
esac
echo "$name $*" >> "${0%/*}/called"
echo "error: a test called '$name $*' of this machine: bring a stand-in" >&2
exit 97
"""


class Guard:
    """A folder of programs that refuse, which is first on PATH as long as the tests run."""

    def __init__(self, folder, refused):
        self.folder = pathlib.Path(folder)
        for name in refused:
            program = self.folder / name
            program.write_text(_REFUSE)
            program.chmod(0o755)
        os.environ["PATH"] = f"{self.folder}:{os.environ['PATH']}"
        os.environ["MRP_TEST_GUARD"] = str(self.folder)
        for name in ("ROS_HOME", "XDG_CACHE_HOME"):  # so does make test
            os.environ.setdefault(name, str(self.folder / name.lower()))

    def calls(self):
        """Return the commands that were refused since the last call."""
        try:
            called = (self.folder / "called").rename(self.folder / "read")
        except FileNotFoundError:
            return []
        return called.read_text().splitlines()

    @pytest.hookimpl(trylast=True)
    def pytest_runtest_teardown(self, item):
        """Fail the test that called one of them."""
        if called := self.calls():
            pytest.fail(f"{item.name} called what it may not: {called}", pytrace=False)

    def pytest_unconfigure(self):
        """Delete the folder."""
        shutil.rmtree(self.folder)


def pytest_configure(config):
    refused = PACKAGES if os.environ.get("MRP_TEST_ENGINE") else PACKAGES + ENGINES
    config.pluginmanager.register(Guard(tempfile.mkdtemp(prefix="mrp_guard_"), refused), "guard")
