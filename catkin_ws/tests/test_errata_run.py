# SPDX-License-Identifier: BSD-3-Clause
"""Builds and runs the code of the original page. A test's name has the number of its erratum.

Most errata that only show in a run are also defects for the checker: test_broken.py runs those.
"""

import re
import shutil
import sys

import pytest
import rosgraph
from mrp_testing import contract, scratch
from mrp_testing.errata import ORIGINAL, PACKAGE, STARTS, mend, replace
from mrp_testing.graph import Graph
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("errata_run")]

TOPIC = contract.GROUP + "/" + contract.TOPIC


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A workspace with the original: built and installed as printed, then mended so that it starts.

    What is mended is in the Python nodes alone, which need no building.
    """
    folder = tmp_path_factory.mktemp("original")
    package = shutil.copytree(ORIGINAL, folder / "src" / PACKAGE)
    scratch.catkin_make(folder, "install")
    mend(package, *STARTS)
    return folder


@pytest.fixture(scope="module")
def launched(built):
    """The four nodes, started by roslaunch and ended as Ctrl-C does."""
    env = scratch.environment()
    port = env["ROS_MASTER_URI"].rsplit(":", 1)[1]
    command = ("roslaunch", "-p", port, PACKAGE, "pub_sub.launch")
    command = scratch.sourced(built / "devel" / "setup.bash", *command)
    with pytest.MonkeyPatch.context() as patch, Process(*command, env=env) as process:
        patch.setenv("ROS_MASTER_URI", env["ROS_MASTER_URI"])
        process.wait_for(rosgraph.is_master_online, "the master answers")
        process.wait_for(lambda: len(on_topic(Graph())) == 4, "all four nodes are on the topic")
        process.stop()
    return process


def on_topic(graph):
    """Return the nodes that publish or subscribe the topic."""
    return graph.publishers.get(TOPIC, []) + graph.subscribers.get(TOPIC, [])


@pytest.fixture(name="master")
def own_master(monkeypatch):
    """A master of the test's own."""
    port = free_port()
    monkeypatch.setenv("ROS_MASTER_URI", uri_of(port))
    with master(port) as process:
        yield process


@pytest.fixture
def package(tmp_path):
    """A copy of the original for one test, of which the Python nodes start."""
    folder = shutil.copytree(ORIGINAL, tmp_path / PACKAGE)
    mend(folder, "e01_global", "e03_parenthesis")
    return folder


def run(*command):
    return Process(*map(str, command), extra_env=LIVE)


def test_e08_its_lines_are_lost_and_roslaunch_says_nothing(launched):
    assert any("lock_error" in line for line in launched.lines)
    assert not any("CPP NODE" in line for line in launched.lines), str(launched)
    assert launched.code == 0


def test_e09_two_slashes_are_warned_of(launched):
    text = f"'{contract.GROUP}//{contract.TOPIC}' is not a legal ROS graph resource name"
    warnings = [line for line in launched.errors if text in line]
    assert len(warnings) == 2, str(launched)  # the two Python nodes
    assert all("UserWarning" in line for line in warnings)


def test_e15_no_node_is_installed(built):
    assert (built / "install" / "share" / PACKAGE / "package.xml").exists()
    assert not (built / "install" / "lib" / PACKAGE).exists()
    assert not (built / "install" / "share" / PACKAGE / "launch").exists()


def test_e20_a_counter_too_large_ends_the_timer_alone(package, master):
    node = package / "src" / "publisher_py_node.py"
    replace(node, "self.counter = 1", "self.counter = 2**32 - 5")
    # It takes a subscriber: rospy packs no message that nobody is to get.
    subscriber = package / "src" / "subscriber_py_node.py"
    with run(sys.executable, subscriber), run(sys.executable, node) as process:
        process.wait_for(
            lambda: any("exceeds specified width [uint32]" in line for line in list(process.lines)),
            "the counter does not fit",
        )
        # It is the thread that has ended, not the node: that goes on until Ctrl-C.
        assert any(line.startswith("Exception in thread") for line in process.errors)
        assert "/publisher_py_node" in Graph().nodes
        assert process.stop() == 0, str(process)


# The console that the original shows is not that of its own code.

SHOWN = (ORIGINAL / "console.txt").read_text().splitlines()
STARTED = re.compile(r"process\[(\S+)-(\d+)\]: started")


def test_p01_numbers_of_the_processes(launched):
    assert {number for _, number in STARTED.findall("\n".join(SHOWN))} == {"1"}
    assert STARTED.findall("\n".join(launched.lines)) == [
        ("rosout", "1"),
        ("mrp/publisher_cpp_node", "2"),
        ("mrp/publisher_py_node", "3"),
        ("mrp/subscriber_cpp_node", "4"),
        ("mrp/subscriber_py_node", "5"),
    ]


def test_p01_what_python_prints(launched):
    shown = [line for line in SHOWN if "PY NODE" in line]
    printed = [line for line in launched.lines if "PY NODE" in line]
    assert all(line.startswith("[ INFO] [") for line in shown)
    assert all(re.match(r"\[INFO\] \[\d+\.\d{6}\]: ", line) for line in printed), str(launched)
    assert any("namespace of nh = /mrp/" in line for line in shown)
    assert not any("namespace of nh" in line for line in printed)


def test_p01_what_cpp_prints(built, master):
    shown = [line for line in SHOWN if "CPP NODE" in line]
    assert all(re.match(r"\[ INFO\] \[\d+\.\d{6}\]: ", line) for line in shown)
    with run(built / "devel" / "lib" / PACKAGE / "publisher_cpp_node") as process:
        process.wait_for(lambda: process.lines, "a line")
        assert re.match(r"\[ INFO\] \[\d+\.\d{9}\]: \[PUBLISHER CPP NODE\]", process.lines[0])


def test_p01_misspelt_names(launched):
    assert sum("publishder" in line for line in SHOWN) == 2
    assert not any("publishder" in line for line in launched.lines)
