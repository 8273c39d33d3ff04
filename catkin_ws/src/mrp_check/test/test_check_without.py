# SPDX-License-Identifier: BSD-3-Clause
"""What CMakeLists.txt, package.xml and launch files say of packages without a contract."""

import check_rules
import pytest
from check_rules import CMAKE, MANIFEST, told
from mrp_check.code import executables
from mrp_check.confined.launch_dump import Started
from mrp_check.package.cmake import Model, parsed
from mrp_check.package.launch import Launch
from mrp_check.rules.files import cmake, dependencies, launch_nodes, messages, scripts

pytestmark = pytest.mark.quick

NODE = "#!/usr/bin/env {}\nimport rospy\nrospy.init_node('a')\n"


def findings(rule, package, **known):
    given = {"spec": executables.spec(package, check_rules.model_of(package)), **known}
    return check_rules.file_findings(rule, package, **given)


@pytest.mark.parametrize(
    ("python", "relayed", "severity"),
    [
        ("python", False, "error"),
        ("python", True, None),
        ("python2", False, "error"),
        ("python2", True, "warning"),
    ],
)
def test_the_first_line_of_a_script_is_to_blame(python, relayed, severity, tmp_path):
    text = CMAKE if relayed else CMAKE.replace("src/odd.py", "src/other.py")
    files = {"src__odd_DOT_py": NODE.format(python), "src__other_DOT_py": NODE.format("python3")}
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, **files)
    found = [one for one in findings(scripts, package) if one.file == "src/odd.py"]
    assert [(one.severity, one.line) for one in found] == ([(severity, 1)] if severity else [])


def test_what_message_generation_brings_is_where_it_is_called(tmp_path):
    text = f"{CMAKE}\n# add_message_files(FILES A.msg)\nadd_message_files(FILES A.msg)\n"
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, msg__A_DOT_msg="")
    found = [one for one in findings(messages, package) if "message_generation," in one.message]
    assert told(found) == [("messages", text.count("\n"))]


def test_what_runs_messages_is_missed_at_its_own_tag(tmp_path):
    own = "<exec_depend>b</exec_depend>"
    manifest = MANIFEST.replace("<depend>rospy</depend>", f"<!-- {own} -->\n{own}")
    files = {
        "CMakeLists_DOT_txt": f"{CMAKE}\nadd_message_files(FILES A.msg)\n",
        "msg__A_DOT_msg": "",
    }
    package = check_rules.make(tmp_path / "some_pkg", package_DOT_xml=manifest, **files)
    (found,) = [one for one in findings(messages, package) if "<exec_depend>" in one.message]
    assert package.line("package.xml", found.line).strip() == own


@pytest.mark.parametrize(("ends", "ids"), [(True, ["cmake"]), (False, [])])
def test_a_call_that_cmake_did_not_come_to_may_be_made(ends, ids, tmp_path):
    text = "cmake_minimum_required(VERSION 3.10)\nproject(a)\nfind_package(catkin REQUIRED)\n"
    rest = {"rest_DOT_cmake": "catkin_package()\n"}
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, **rest)
    model = Model(package.root, parsed(text, "CMakeLists.txt"), complete=ends)
    assert [one.id for one in findings(cmake, package, model=model)] == ids


@pytest.mark.parametrize(("name", "number"), [("catkin", 1), ("catkin_simple", 0)])
def test_catkin_simple_finds_what_package_xml_names(name, number, tmp_path):
    text = CMAKE.replace("catkin REQUIRED COMPONENTS roscpp rospy", f"{name} REQUIRED COMPONENTS")
    text += "\nadd_executable(a src/a.cpp)\n"
    source = {"src__a_DOT_cpp": "#include <ros/ros.h>\n"}
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, **source)
    found = [one for one in findings(dependencies, package) if "find_package" in one.message]
    assert len(found) == number


@pytest.mark.parametrize(("name", "found"), [("a_1", []), ("a.py", [("launch-nodes", 2)])])
def test_a_name_that_ros_warns_of(name, found, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", src__odd_DOT_py=NODE.format("python"))
    node = Started("some_pkg", "odd.py", name, "/", "", [], [], "", "", "launch/a.launch", 2)
    launch = Launch("", nodes=[node], files=[], file="launch/a.launch")
    assert told(findings(launch_nodes, package, launch=launch), "warning") == found


@pytest.mark.parametrize(
    ("package_name", "program", "found"),
    [
        ("some", "od", [("package-name", 2)]),
        ("some", "other", []),
        ("other", "od", []),
    ],
)
def test_a_launch_file_of_before_the_package_was_renamed(package_name, program, found, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", src__odd_DOT_py=NODE.format("python"))
    node = Started(package_name, program, "a", "/", "", [], [], "", "", "launch/a.launch", 2)
    launch = Launch("", nodes=[node], files=[], file="launch/a.launch")
    assert told(findings(launch_nodes, package, launch=launch), "warning") == found
