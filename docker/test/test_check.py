# SPDX-License-Identifier: BSD-3-Clause
"""The image mrp-check, as somebody uses it whose package is not ours."""

import json
import os
import pathlib
import shutil

import pytest
from containers import ROOT, inspect, run

IMAGE = "mrp-check:" + os.environ.get("DEBIAN", "trixie")
# It needs messages that Debian does not have.
FILES = {
    "package.xml": """<package format="2">
  <name>turtle_logger</name>
  <version>1.2.3</version>
  <description>Logs where a turtle is</description>
  <maintainer email="me@mrp.example">Me</maintainer>
  <license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>roscpp</depend>
  <depend>turtlesim</depend>
</package>
""",
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.10)
project(turtle_logger)
find_package(catkin REQUIRED COMPONENTS roscpp turtlesim)
catkin_package()
include_directories(${catkin_INCLUDE_DIRS})
add_executable(logger logger.cpp)
target_link_libraries(logger ${catkin_LIBRARIES})
install(TARGETS logger RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
""",
    "logger.cpp": """#include <ros/ros.h>
#include <turtlesim/Pose.h>

void print(const turtlesim::Pose::ConstPtr& pose)
{
  ROS_INFO("x = %f", pose->x);
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "logger");
  ros::NodeHandle nh;
  ros::Subscriber subscriber = nh.subscribe("turtle1/pose", 10, print);
  ros::spin();
}
""",
    "all.launch": """<launch>
  <node pkg="turtlesim" type="turtlesim_node" name="sim"/>
  <node pkg="turtle_logger" type="logger" name="logger"/>
</launch>
""",
}


@pytest.mark.parametrize(
    ("field", "code", "says"),
    [("->x", 0, "Errors: 0"), ("->z", 1, "logger.cpp:6: error:")],
    ids=["correct", "broken"],
)
def test_it_checks_a_package_that_needs_turtlesim(field, code, says, tmp_path):
    for name, text in FILES.items():
        pathlib.Path(tmp_path, name).write_text(text.replace("->x", field))
    done = run("docker", "run", "--rm", f"-v{tmp_path}:/pkg", IMAGE, "/pkg", check=False)
    assert done.returncode == code and says in done.stdout, done.stdout


def test_gradescopes_zip_installs_nothing_in_it_and_gives_points(tmp_path):
    """The folders are those that Gradescope makes."""
    source, submission = tmp_path / "source", tmp_path / "submission"
    run(ROOT / "catkin_ws/tools/make_autograder.py", tmp_path / "autograder.zip")
    run("/usr/bin/python3", "-m", "zipfile", "-e", tmp_path / "autograder.zip", source)
    shutil.copytree(ROOT / "catkin_ws/src/mrp", submission, ignore=shutil.ignore_patterns("doc"))
    (tmp_path / "results").mkdir()
    shutil.copy(source / "run_autograder", tmp_path)
    mounted = ("--network=none", f"-v{tmp_path}:/autograder", "--entrypoint=bash")
    script = "bash /autograder/source/setup.sh && bash /autograder/run_autograder"
    done = run("docker", "run", "--rm", *mounted, IMAGE, "-c", script)
    results = json.loads((tmp_path / "results" / "results.json").read_text())
    tests = results["tests"]
    assert tests and all(test["score"] == test["max_score"] for test in tests), done.stdout
    assert "Installing" not in done.stdout


def test_it_says_what_it_is():
    labels = inspect(IMAGE)["Config"]["Labels"]
    assert labels["org.opencontainers.image.licenses"] == "BSD-3-Clause"
    assert labels["org.opencontainers.image.version"].count(".") == 2
