# SPDX-License-Identifier: BSD-3-Clause
"""Where the machine grants a cgroup v2, the kernel itself keeps what runs within its limits.

Elsewhere these tests see that a command runs without one.
"""

import pathlib
import subprocess

import pytest
from mrp_check import sandbox
from mrp_check.sandbox import confine

pytestmark = pytest.mark.quick

LIMITS = confine.Limits(memory=40 * 2**20, disk=10 * 2**20, processes=5)


@pytest.fixture
def cgroups(tmp_path, monkeypatch):
    """A folder in place of /sys/fs/cgroup."""
    monkeypatch.setattr(sandbox, "CGROUPS", tmp_path)
    monkeypatch.setattr(sandbox, "EMPTYING", 0)
    return tmp_path


def test_its_limits_are_those_of_the_run(cgroups):
    """It is made below the nearest cgroup that shares out memory and processes."""
    entries = pathlib.Path("/proc/self/cgroup").read_text().splitlines()
    own = next((entry[4:] for entry in entries if entry.startswith("0::/")), "")
    (cgroups / own).mkdir(parents=True, exist_ok=True)
    (cgroups / own / "cgroup.subtree_control").write_text("cpu\n")
    with sandbox.cgroup(LIMITS) as group:
        assert group is None
    (cgroups / own / "cgroup.subtree_control").write_text("cpu memory pids\n")
    with sandbox.cgroup(LIMITS) as group:
        assert group.parent == cgroups / own
        bounds = [(group / name).read_text() for name in ("memory.max", "pids.max")]
    assert bounds == [str(50 * 2**20), "15"]


def test_without_one_a_command_runs_as_it_is(cgroups):
    with sandbox.cgroup(LIMITS) as group:
        assert (group, sandbox.entering(group), sandbox.ran_out_of_memory(group)) == (
            None,
            [],
            False,
        )


def test_who_cannot_enter_it_runs_all_the_same(tmp_path):
    command = [*sandbox.entering(tmp_path / "none"), "echo", "It runs."]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("It runs.\n", "")


def run_in(group, program):
    command = [*sandbox.entering(group), "/usr/bin/python3", "-c", program]
    return subprocess.run(command, capture_output=True, text=True)


def test_the_kernel_ends_what_takes_too_much_memory_where_it_is_granted():
    with sandbox.cgroup(LIMITS) as group:
        assert run_in(group, "x = bytearray(20 * 2**20)").returncode == 0
        assert not sandbox.ran_out_of_memory(group)
        done = run_in(group, "x = b'x' * (200 * 2**20)")
        assert (done.returncode != 0) == sandbox.ran_out_of_memory(group) == (group is not None)
    assert group is None or not group.exists()


# The children end with their parent, as nobody else can write into the pipe.
FORKS = """
import os
read, write = os.pipe()
try:
    for made in range(30):
        if os.fork() == 0:
            os.close(write)
            os.read(read, 1)
            os._exit(0)
except BlockingIOError:
    print("No more")
"""


def test_the_kernel_makes_no_more_processes_where_it_is_granted():
    with sandbox.cgroup(LIMITS) as group:
        assert ("No more" in run_in(group, FORKS).stdout) == (group is not None)
