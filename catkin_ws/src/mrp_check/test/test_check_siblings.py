# SPDX-License-Identifier: BSD-3-Clause
"""Checks a workspace: one report for each package, which is built with those of the same repository
that it needs."""

import json
import types

import check_rules
import pytest
from mrp_check.cli import check as command
from mrp_check.contract.errors import CannotCheck
from mrp_check.package import siblings
from mrp_check.package.package import Package
from mrp_check.rules.run import compile

_MSGS = """\
cmake_minimum_required(VERSION 3.10)
project(a_msgs)
find_package(catkin REQUIRED COMPONENTS message_generation std_msgs)
add_message_files(FILES Count.msg)
generate_messages(DEPENDENCIES std_msgs)
catkin_package(CATKIN_DEPENDS message_runtime std_msgs)
"""
_NODES = """\
cmake_minimum_required(VERSION 3.10)
project(a_nodes)
find_package(catkin REQUIRED COMPONENTS a_msgs roscpp rospy)
catkin_package()
include_directories(${catkin_INCLUDE_DIRS})
add_executable(counts src/counts.cpp)
target_link_libraries(counts ${catkin_LIBRARIES})
add_dependencies(counts ${catkin_EXPORTED_TARGETS})
"""
_COUNTS = """\
#include <a_msgs/Count.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "counts");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<a_msgs::Count>("count", 10);
  ros::Rate rate(10);
  while (ros::ok())
  {
    publisher.publish(a_msgs::Count());
    rate.sleep();
  }
}
"""
_HEARS = """\
#!/usr/bin/env python3
import rospy
from a_msgs.msg import Count


def hear(message):
    rospy.loginfo("heard %s", message.count)


rospy.init_node("hears")
subscriber = rospy.Subscriber("count", Count, hear)
rospy.spin()
"""


def manifest(name, *needed):
    tags = "".join(f"  <depend>{dependency}</depend>\n" for dependency in needed)
    return check_rules.MANIFEST.replace("some_pkg", name).replace("</package>", f"{tags}</package>")


@pytest.fixture
def workspace(tmp_path):
    """A workspace of a package of messages, one with nodes that need it, and one beside them."""
    src = tmp_path / "workspace" / "src"
    makes = ("message_generation", "message_runtime")
    made = {"CMakeLists_DOT_txt": _MSGS, "msg__Count_DOT_msg": "int32 count\n"}
    check_rules.make(src / "a_msgs", package_DOT_xml=manifest("a_msgs", *makes), **made)
    nodes = {"src__counts_DOT_cpp": _COUNTS, "scripts__hears_DOT_py": _HEARS}
    nodes["CMakeLists_DOT_txt"] = _NODES
    check_rules.make(src / "a_nodes", package_DOT_xml=manifest("a_nodes", "a_msgs"), **nodes)
    return src.parent


@pytest.mark.quick
def test_a_package_needs_what_its_manifest_names_and_what_that_needs(workspace):
    last = workspace / "src" / "last"
    check_rules.make(last, package_DOT_xml=manifest("last", "a_nodes", "roscpp", "nowhere"))
    found = {path.name: path for path in siblings.packages_in(workspace)}
    assert [*found] == ["a_msgs", "a_nodes", "last"]
    assert [package.name for package in siblings.needed(Package(last))] == ["a_nodes", "a_msgs"]
    assert siblings.needed(Package(found["a_msgs"])) == []
    alone = check_rules.make(workspace / "elsewhere", package_DOT_xml=manifest("alone", "a_msgs"))
    assert siblings.needed(alone) == []  # without a repository, only what lies in the same folder
    (workspace / ".git").mkdir()
    assert [package.name for package in siblings.needed(alone)] == ["a_msgs"]


@pytest.mark.quick
@pytest.mark.parametrize("folder", ["a_msgs", "a_nodes"])
def test_what_fails_in_another_package_is_not_this_ones_fault(folder, workspace):
    """One that this package is built with may need what isn't on this machine."""
    package = Package(workspace / "src" / "a_nodes")
    package.siblings = siblings.needed(package)
    output = f"make[2]: *** [{folder}/CMakeFiles/a.dir/build.make:76: {folder}/a.o] Error 1\n"
    output += f"make[1]: *** [CMakeFiles/Makefile2:1409: {folder}/CMakeFiles/a.dir/all] Error 2\n"
    built = types.SimpleNamespace(ok=False, output=output, why_ended="")
    case = check_rules.case_of(package, workspace / "scratch", built=built)
    try:
        found = [*compile.findings(case)]
    except CannotCheck as error:
        found = [f"{error}"]
    case.close()
    assert len(found) == 1
    assert ("It's built with a_msgs, which can't" in f"{found[0]}") == (folder == "a_msgs")


@pytest.mark.slow
def test_each_package_of_a_workspace_has_its_own_report(workspace, tmp_path, capsys):
    words = [str(workspace), "--any", f"--json={tmp_path / 'report.json'}"]
    assert command.run(command.parser().parse_args(words)) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith(f"{workspace / 'src' / 'a_msgs'}:\n")
    assert "builds a_msgs with a_nodes" in printed.err and "Not on this machine" not in printed.err
    for name in ("a_msgs", "a_nodes"):
        report = json.loads((tmp_path / f"report-{name}.json").read_text())
        assert (report["package"], report["verdict"]) == (name, "met")
    states = report["requirements"]
    assert [states[id_] for id_ in ("compile", "starts", "topic", "type")] == ["met"] * 4
