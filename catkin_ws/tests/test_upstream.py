# SPDX-License-Identifier: BSD-3-Clause
"""What ROS itself does wrong: with the patch of its report, each lab goes as one would expect.

What happens without it is shown by the lab's own test, which the report in doc/upstream/ names. The
patches are applied to a copy of what is installed.
"""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest
import rosgraph
from mrp_testing.lab import Lab
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.slow

UPSTREAM = WORKSPACE / "src" / "mrp" / "doc" / "upstream"
INSTALLED = pathlib.Path(rosgraph.__file__).parent.parent
# Where Debian's source package of ros_comm has the Python packages that a patch touches.
SOURCES = {"clients/rospy/src": "rospy", "tools/rosmaster/src": "rosmaster"}


@pytest.fixture
def patched(request, tmp_path, monkeypatch):
    """Have a master, and nodes whose ROS has the patch of this test's name."""
    name = request.function.__name__.removeprefix("test_")
    port = free_port()
    paths = [*apply(name, tmp_path), os.environ["PYTHONPATH"]]
    monkeypatch.setenv("PYTHONPATH", ":".join(paths))
    monkeypatch.setenv("ROS_MASTER_URI", uri_of(port))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    with master(port):
        yield tmp_path


def apply(name, folder):
    """Apply a patch to a copy of what is installed; return the copy's folders of packages."""
    for source, package in SOURCES.items():
        shutil.copytree(INSTALLED / package, folder / source / package)
    patch(name, folder)
    return [str(folder / source) for source in SOURCES]


def patch(name, folder):
    """Apply the first patch of a report to a folder."""
    diff = (UPSTREAM / f"{name}.md").read_text().split("```diff\n")[1].split("```")[0]
    subprocess.run(["patch", "-p1"], cwd=folder, input=diff, check=True, text=True)


def node(program):
    """Run a Python program that begins a node of the name a_node."""
    begin = "import rospy; rospy.init_node('a_node'); print('up')\n"
    return Process(sys.executable, "-c", begin + program, extra_env=LIVE)


def test_every_report_has_its_test():
    assert all(f"test_{path.stem}" in globals() for path in UPSTREAM.glob("*.md"))


def test_log_line_ends_the_newer_node(patched):
    program = "rospy.on_shutdown(lambda: rospy.loginfo('goodbye')); rospy.spin()"
    with node(program) as older:
        older.wait_for(lambda: "up" in older.lines, "the older one")
        with node(program) as newer:
            assert older.wait() == 0
            newer.wait_for(lambda: "up" in newer.lines, "the newer one")
            assert newer.stop() == 0
            assert "new node registered" in "\n".join(older.lines)
            assert "new node registered" not in "\n".join(newer.lines)


def test_ctrl_c_in_a_log_call_never_ends_the_node(patched):
    for _ in range(4):
        with node("while not rospy.is_shutdown(): rospy.loginfo('a line')") as logs:
            logs.wait_for(lambda: len(logs.lines) > 9, "lines")
            assert logs.stop() == 0


def test_refused_value_deafens_subscribers(patched):
    with Lab("refused_value.launch") as lab:
        lab.wait_for_count("/refused/subscriber_py", 4)
        assert lab.values("/refused/subscriber_py")[:4] == ["1", "2", "4", "5"]


def test_sleep_without_a_clock_is_silent(patched):
    rosgraph.Master("/test").setParam("/use_sim_time", True)
    with node("rospy.sleep(1)") as sleeper:
        sleeper.wait_for(lambda: "no message has come on /clock" in str(sleeper), "the warning")


def test_cmake_4_refuses_every_workspace(tmp_path):
    """No CMake complains, not even one that warns of what CMake 4 refuses."""
    (tmp_path / "cmake").mkdir()
    shutil.copy("/usr/share/catkin/cmake/toplevel.cmake", tmp_path / "cmake")
    # catkin's own CMakeLists.txt, which the patch changes as well, is not installed.
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.0.2)\n\n"
        "set(catkin_EXTRAS_DIR ${CMAKE_CURRENT_SOURCE_DIR}/cmake)\n\n"
    )
    patch("cmake_4_refuses_every_workspace", tmp_path)
    (tmp_path / "src").mkdir()
    # What a CMake before 4 does not refuse, it says: which version the workspace is written for.
    text = (tmp_path / "cmake" / "toplevel.cmake").read_text()
    (tmp_path / "src" / "CMakeLists.txt").write_text(
        text + 'cmake_policy(GET CMP0065 new)\nmessage("written for CMake 3.4 or later: ${new}")\n'
    )
    environment = {k: v for k, v in os.environ.items() if k != "CMAKE_POLICY_VERSION_MINIMUM"}
    command = ["cmake", "-S", "src", "-B", "build", "-DPYTHON_EXECUTABLE=/usr/bin/python3"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "written for CMake 3.4 or later: NEW" in done.stderr
    assert "Compatibility with CMake" not in done.stderr


def test_both_nodes_of_one_name_go_on(patched):
    arguments = ("one_name.launch", "asked_once:=true")
    with Lab(*arguments, "hostname:=no-such-host") as older:
        older.wait_for(lambda: older.logged("/one_name/publisher_py"), "the older node")
        with Lab(*arguments):
            warning = "cannot shut down node [/one_name/publisher_py]"
            log = patched / "master.log"
            wait_until(lambda: warning in log.read_text(), lambda: log.read_text()[-2000:])
