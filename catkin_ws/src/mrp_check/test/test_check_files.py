# SPDX-License-Identifier: BSD-3-Clause
"""The rules about files: texts, package.xml, CMakeLists.txt, messages and launch files."""

import dataclasses
import re
import types

import check_rules
import pytest
from check_rules import CMAKE, MANIFEST, NODE, file_findings, told
from mrp_check import releases
from mrp_check.code import executables, uses
from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.package import cmake
from mrp_check.package import manifest as manifests
from mrp_check.package.cmake import Model, parsed
from mrp_check.rules.files import cmake as cmake_rule
from mrp_check.rules.files import (
    dependencies,
    manifest,
    messages,
    package_name,
    scripts,
    targets,
    text,
)
from mrp_check.rules.run import compile
from one_source import SPEC, case, lines_of

pytestmark = pytest.mark.quick

LATIN1 = b"#!/usr/bin/env python\n# coding: latin-1\n# \xe4\n"


@pytest.mark.parametrize(
    ("content", "cmake_text", "expected"),
    [
        (NODE.encode(), "", []),
        ("#!/usr/bin/env python\n# ä\n".encode(), "", []),
        (LATIN1, "", []),
        (LATIN1.replace(b"coding", b"letters"), "", [("text", 3)]),
        (LATIN1, CMAKE, [("text", 3)]),  # what catkin_install_python() makes reads it as UTF-8
        (NODE.encode("utf-16"), "", [("text", 1)]),
    ],
    ids=range(6),
)
def test_text(content, cmake_text, expected, tmp_path):
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt=cmake_text, src__odd_DOT_py=content)
    assert told(file_findings(text, package)) == expected


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("</description>", "", 5, "<description> is opened"),
        ("</package>", "", 2, "<package> is opened there and not closed"),
        ("<version>0.1.0</version>", "", 2, "version"),
        (' email="someone@some.example"', "", 6, "email"),
        ("<depend>rospy", "<dependd>rospy", 10, "dependd"),
        ("<depend>rospy</depend>", "<run_depend>rospy</run_depend>", 10, "run_depend"),
        ("  <buildtool_depend>catkin</buildtool_depend>\n", "", 8, "built with catkin"),
    ],
    ids=range(7),
)
def test_broken_manifest(old, new, line, says, tmp_path):
    assert MANIFEST.count(old) == 1
    package = check_rules.make(tmp_path, **{"package_DOT_xml": MANIFEST.replace(old, new)})
    findings = file_findings(manifest, package)
    assert told(findings) == [("manifest", line)]
    assert says in findings[0].message


def test_a_package_of_ros_2_is_one_error(tmp_path):
    manifest_text = MANIFEST.replace(">catkin<", ">ament_cmake<")
    cmake_text = "cmake_minimum_required(VERSION 3.10)\nproject(some_pkg)\nament_package()\n"
    package = check_rules.make(
        tmp_path, package_DOT_xml=manifest_text, CMakeLists_DOT_txt=cmake_text
    )
    (finding,) = file_findings(manifest, package) + file_findings(cmake_rule, package)
    assert (finding.id, finding.line) == ("manifest", 8)
    assert finding.message.startswith("This is a package for ROS 2: it needs ament_cmake")


def dependency_findings(folder, manifest_text=MANIFEST, cmake_text=CMAKE, **files):
    files = {"src__odd_DOT_py": NODE, "src__a_DOT_cpp": "#include <ros/ros.h>\n", **files}
    cmake_text += "add_executable(a src/a.cpp)\n"
    package = check_rules.make(
        folder, **{"package_DOT_xml": manifest_text, "CMakeLists_DOT_txt": cmake_text}, **files
    )
    return file_findings(dependencies, package)


def test_what_is_declared_is_no_finding(tmp_path):
    assert told(dependency_findings(tmp_path), "error", "warning", "note") == []


def test_all_that_is_missing_is_one_finding(tmp_path):
    text_ = re.sub(r"  <depend>(rospy|std_msgs)</depend>\n", "", MANIFEST)
    (finding,) = dependency_findings(tmp_path, text_)
    assert (finding.file, finding.line, finding.severity) == ("package.xml", 9, "error")
    assert "rospy (used in src/odd.py:2) and std_msgs (used in src/odd.py:3)." in finding.message
    assert finding.change[1].endswith("<depend>rospy</depend>\n  <depend>std_msgs</depend>")


def test_missing_dependency_that_is_not_here_either(tmp_path):
    files = {"src__b_DOT_py": f"from some_other_msgs.msg import Odd\n{NODE}"}
    package = check_rules.make(tmp_path, src__a_DOT_cpp="", **files)
    without = dataclasses.replace(check_rules.PUB_SUB, is_contract=False)
    found = file_findings(dependencies, package, spec=without)
    assert [f.file for f in found if "some_other_msgs" in f.message] == ["package.xml"]
    assert file_findings(dependencies, package) == []


@pytest.mark.parametrize(
    ("files", "name"),
    [
        ({"launch__a_DOT_launch": '<launch>\n<node pkg="turtlesim" name="a" type="b"/>'}, "turtle"),
        ({"launch__a_DOT_launch": '<include file="$(find roslib)/a.launch"/>'}, "roslib"),
        ({"launch__a_DOT_launch": '<!-- <node pkg="turtlesim"/> -->\n$(find some_pkg)'}, None),
        ({"src__b_DOT_py": "import genpy\nprint 'a'\n"}, "genpy"),
    ],
)
def test_a_dependency_of_a_launch_file_or_of_python_2_is_named(files, name, tmp_path):
    package = check_rules.make(tmp_path, **files)
    without = dataclasses.replace(check_rules.PUB_SUB, is_contract=False)
    found = file_findings(dependencies, package, spec=without)
    texts = [f.message for f in found if f.severity == "warning"]
    assert len(texts) == bool(name) and all(f"doesn't name {name}" in text for text in texts)


def test_what_a_launch_file_and_a_source_use_is_one_finding(tmp_path):
    launch = '<launch><node pkg="turtlesim" name="a" type="b"/></launch>'
    files = {"launch__a_DOT_launch": launch, "src__b_DOT_py": "import tf\n"}
    package = check_rules.make(tmp_path, **files)
    without = dataclasses.replace(check_rules.PUB_SUB, is_contract=False)
    (message,) = [finding.message for finding in file_findings(dependencies, package, spec=without)]
    assert "tf (used in" in message and "turtlesim (used in" in message


def test_comment_uses_nothing(tmp_path):
    other = "#include <ros/package.h>\n"
    source = f"#include <ros/ros.h>\n// {other}/*\n{other}*/\n"
    assert told(dependency_findings(tmp_path, src__a_DOT_cpp=source)) == []


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs)\n", "", 2, "find_package"),
        ("catkin_package(", "add_executable(b src/a.cpp)\ncatkin_package(", 5, "comes after"),
        ("catkin_package(", "catkin_package(INCLUDE_DIRS include ", 4, "no such folder"),
    ],
    ids=range(3),
)
def test_broken_cmake(old, new, line, says, tmp_path):
    assert CMAKE.count(old) == 1
    package = check_rules.make(
        tmp_path, CMakeLists_DOT_txt=CMAKE.replace(old, new), src__a_DOT_cpp="int main() {}\n"
    )
    (finding,) = [*file_findings(cmake_rule, package), *file_findings(targets, package)]
    assert (finding.file, finding.line) == ("CMakeLists.txt", line)
    assert says in finding.message


def test_cmake_as_text():
    calls = cmake.parsed(
        "# add_executable(no no.cpp)\nset(SOURCES a.cpp\n  b.cpp) #[[ add_library(no) ]]\n"
        'project("x")\nADD_EXECUTABLE(${PROJECT_NAME}_a ${SOURCES})\n',
        "CMakeLists.txt",
    )
    assert [call[:2] + call[3:] for call in calls] == [
        ("set", ["SOURCES", "a.cpp", "b.cpp"], 2),
        ("project", ["x"], 4),
        ("add_executable", ["x_a", "a.cpp", "b.cpp"], 5),
    ]


def test_who_is_wrong_about_the_name_is_decided_by_the_others(tmp_path):
    package = check_rules.make(tmp_path / "some_pkg")
    assert file_findings(package_name, package) == []
    text_ = CMAKE.replace("project(some_pkg)", "project(other)")
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text_)
    (finding,) = file_findings(package_name, package)
    assert (finding.file, finding.line) == ("CMakeLists.txt", 2)
    package = check_rules.make(tmp_path / "other", CMakeLists_DOT_txt=text_)
    (finding,) = file_findings(package_name, package)
    assert (finding.file, finding.line) == ("package.xml", 3)


def with_messages(folder, calls, generator="message_generation", **files):
    """Make a package with these calls in the place of catkin_package()."""
    needs = f"<depend>{generator}</depend><depend>message_runtime</depend></package>"
    text_ = CMAKE.replace("catkin_package(CATKIN_DEPENDS roscpp rospy std_msgs)", calls)
    return check_rules.make(
        folder,
        package_DOT_xml=MANIFEST.replace("</package>", needs),
        CMakeLists_DOT_txt=text_.replace("roscpp rospy", f"{generator} roscpp rospy"),
        **files,
    )


@pytest.mark.parametrize(
    ("generator", "configures", "severities"),
    [
        ("message_generation", True, []),
        ("genmsg", True, ["warning"]),
        ("roslib", False, ["error"]),
        ("actionlib_msgs", True, ["warning"]),
    ],
)
def test_what_makes_messages(generator, configures, severities, tmp_path):
    """actionlib_msgs brings along what makes messages: CMake goes through."""
    calls = "add_message_files(FILES A.msg)\ngenerate_messages()"
    package = with_messages(tmp_path, calls, generator, msg__A_DOT_msg="int32 a\n")
    model = check_rules.model_of(package)
    model.complete = configures
    found = file_findings(messages, package, model=model)
    assert [finding.severity for finding in found] == severities


def test_code_is_made_of_the_messages_of_an_action(tmp_path):
    calls = "add_action_files(FILES Do.action)\ngenerate_messages()\ncatkin_package()"
    made = {f"msg__{name}_DOT_msg": "" for name in ("DoActionGoal", "DoResult", "DoAction", "Do2")}
    package = with_messages(tmp_path, calls, action__Do_DOT_action="---\n---\n", **made)
    found = [finding.message for finding in file_findings(messages, package)]
    assert [text_[: text_.index(".msg")] for text_ in found if ".msg is" in text_] == ["msg/Do2"]


@pytest.mark.parametrize(
    ("folder", "says"),
    [("srv__", []), ("", ["looks for srv/Ask.srv, but the file is at Ask.srv, so CMake stops."])],
)
def test_a_definition_lies_where_cmake_looks_for_it(folder, says, tmp_path):
    calls = "add_service_files(FILES Ask.srv)\ngenerate_messages()\ncatkin_package()"
    package = with_messages(tmp_path, calls, **{f"{folder}Ask_DOT_srv": "int32 a\n---\n"})
    found = file_findings(messages, package)
    assert [finding.message.partition("() ")[2] for finding in found] == says


@pytest.mark.parametrize(
    ("without", "file", "says"),
    [
        ("", "", ""),
        ("add_dependencies(a some_pkg_gencpp)\n", "CMakeLists.txt: add_exec", "doesn't wait"),
        ("generate_messages()\n", "CMakeLists.txt: add_service_files", "never calls generate"),
        ("add_service_files(FILES Ask.srv)\n", "CMakeLists.txt: find_pac", "add_service_files()"),
    ],
)
def test_own_service_is_made_before_it_is_used(without, file, says, tmp_path):
    calls = (
        "add_service_files(FILES Ask.srv)\ngenerate_messages()\ncatkin_package()\n"
        "add_executable(a src/a.cpp)\nadd_dependencies(a some_pkg_gencpp)\n"
        "add_library(own src/own.cpp)\nadd_dependencies(own some_pkg_gencpp)\n"
        "add_executable(linked src/a.cpp)\ntarget_link_libraries(linked own)\n"
    )
    files = {"src__a_DOT_cpp": "#include <some_pkg/AskRequest.h>\n", "srv__Ask_DOT_srv": "---\n"}
    files["src__own_DOT_cpp"] = ""
    package = with_messages(tmp_path, calls.replace(without, ""), **files)
    found = [
        f"{finding.file}: {package.lines(finding.file)[finding.line - 1]} {finding.message}"
        for finding in file_findings(messages, package)
    ]
    assert len(found) == bool(without)
    assert all(f.startswith(file) and says in f for f in found), found


@pytest.mark.parametrize(
    ("name", "language", "debian", "says"),
    [
        ("geometry_msgs", "cpp", {"libgeometry-msgs-dev"}, "(Debian package libgeometry-msgs-dev)"),
        ("map_msgs", "cpp", {"ros-map-msgs"}, "(Debian package ros-map-msgs)"),
        ("cv2", "python", {"python3-opencv"}, "(Debian package python3-opencv)"),
        ("tkinter", "python", {"python3-tk"}, "(Debian package python3-tk)"),
        ("mrs_lib", "cpp", {"libtf-dev"}, "(not in Debian)"),
        ("mrs_lib", "cpp", set(), "(perhaps Debian package libmrs-lib-dev)"),
    ],
)
def test_a_package_that_is_not_here_is_named_as_debian_has_it(
    name, language, debian, says, monkeypatch
):
    monkeypatch.setattr(uses, "debian_packages", lambda: debian)
    assert says in uses.absent(name, language)


@pytest.mark.parametrize(
    ("name", "found"), [("our_turtle", []), ("Some_pkg", [3]), ("2_pkg", [3]), ("some-pkg2", [])]
)
def test_a_package_has_a_usual_name(name, found, tmp_path, capfd):
    text, cmake_text = (template.replace("some_pkg", name) for template in (MANIFEST, CMAKE))
    package = check_rules.make(tmp_path, package_DOT_xml=text, CMakeLists_DOT_txt=cmake_text)
    assert [finding.line for finding in file_findings(package_name, package, spec=SPEC)] == found
    assert capfd.readouterr() == ("", "")  # catkin_pkg prints its warnings, unless asked not to


INIT = 'ros::init(argc, argv, "a");'
MADE_BY_CMAKE = """cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS roscpp)
catkin_package()
add_executable(a src/a.cpp)
"""


@pytest.mark.parametrize(
    ("line", "named", "found"),
    [
        ("import pandas", "std_msgs", "python3-pandas"),
        ("import pandas", "python3-pandas", ""),
        ("from nowhere_tutorials.srv import Add", "std_msgs", "nowhere_tutorials"),
        ("from nowhere_tutorials.srv import Add", "nowhere_tutorials", ""),
        ("import cv2", "cv_bridge", ""),
        ("import cv2", "std_msgs", "python3-opencv"),
        ("import json, yaml, rospy, own", "std_msgs", ""),
        ("from std_msgs.msg import String", "std_srvs", ""),
    ],
    ids=range(8),
)
def test_what_others_made_is_named_in_the_manifest(line, named, found, tmp_path, monkeypatch):
    monkeypatch.setattr(uses, "is_of_debian", lambda module: module in ("pandas", "cv2"))
    package = check_rules.make(
        tmp_path / "some_pkg",
        src__a_DOT_py=line,
        src__own_DOT_py="",
        package_DOT_xml=check_rules.MANIFEST.replace("std_msgs", named),
    )
    entries = [f.expected for f in file_findings(dependencies, package, dependencies.undeclared)]
    assert entries == [f"<depend>{found}</depend> in package.xml"] * bool(found)


@pytest.mark.parametrize(("header", "found"), [("yaml-cpp/yaml.h", [1]), ("vector", [])])
def test_a_library_is_named_in_the_manifest(header, found, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_cpp=f"#include <{header}>\n")
    findings = file_findings(dependencies, package, dependencies.undeclared)
    assert [finding.line for finding in findings] == found


# CMake 3.25 warns of what is older than 2.8.12, CMake 3.31 of what is older than 3.10.
@pytest.mark.parametrize(
    ("version", "release", "found"),
    [
        *[("2.8.3", 12, [WARNING]), ("2.8.12", 12, [NOTE]), ("3.0.2", 12, [NOTE])],
        *[("3.0.2...3.4", 12, [NOTE]), ("3.0.2", 13, [WARNING]), ("3.0.2", None, [NOTE])],
        *[("3.5", 12, []), ("3.10", 12, []), ("2.8...3.20", 12, []), ("3.0.2...3.5", 12, [])],
    ],
)
def test_cmakelists_is_not_of_an_old_cmake(version, release, found, tmp_path, monkeypatch):
    """It is a note where only a newer CMake says so."""
    monkeypatch.setattr(releases, "here", lambda: release)
    text_ = MADE_BY_CMAKE.replace("3.10", version)
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt=text_)
    findings = file_findings(cmake_rule, package, spec=SPEC)
    assert [finding.severity for finding in findings] == found


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("from some_pkg.msg import Own", [1]),
        ("import some_pkg", []),
        ("import some_pkg_of_others", []),
    ],
    ids=range(3),
)
def test_a_script_hides_the_module_that_it_imports(line, found, tmp_path):
    text = f"#!/usr/bin/env python3\n{line}\nimport rospy\nrospy.init_node('a')\n"
    package = check_rules.make(tmp_path / "some_pkg", scripts__some_pkg_DOT_py=text)
    findings = check_rules.file_findings(scripts, package, spec=SPEC)
    assert [f.line for f in findings if "own folder" in f.message] == [2] * len(found)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("add_compile_options(-std=c++11)", [6]),
        ("set(CMAKE_CXX_STANDARD 14)", [6]),
        ("set(CMAKE_CXX_STANDARD 17)", []),
        ("# add_compile_options(-std=c++11)", []),
    ],
)
def test_a_standard_of_cpp_that_newer_headers_do_not_take(line, found, tmp_path):
    known = case(tmp_path, "cpp", INIT, CMakeLists_DOT_txt=f"{MADE_BY_CMAKE}{line}\n")
    known.package_folder = known.package.root
    known.built = types.SimpleNamespace(ok=True, output="")
    assert lines_of(compile, known) == found
    output = (
        "a.h:1:2: error: #error This file requires compiler support for the ISO C++ 2011 standard"
    )
    known.built.output = output
    assert lines_of(compile, known) == []  # it is said as an error where the compiler says so


@pytest.mark.parametrize(
    ("source", "severity"), [("b.cpp", ERROR), ("left.cpp", WARNING), ("b.msg", ERROR)]
)
def test_a_definition_of_which_no_code_is_made(source, severity, tmp_path):
    """Where nothing uses it, nothing else is missed, either."""
    text = "project(some_pkg)\nfind_package(catkin REQUIRED COMPONENTS roscpp)\n"
    folder = "msg" if source.endswith(".msg") else "src"
    known = case(
        *(tmp_path, "cpp", INIT),
        CMakeLists_DOT_txt=f"{text}add_executable(a src/a.cpp src/b.cpp)\n",
        msg__Own_DOT_msg="int32 a",
        **{f"{folder}__{source.replace('.', '_DOT_')}": "#include <some_pkg/Own.h>\nOwn a"},
    )
    known.manifest = manifests.parse(known.package)
    known.spec = types.SimpleNamespace(**vars(known.spec), messages={}, services={})
    found = [*check_rules.of(messages.RULE, known)]
    (finding,) = [f for f in found if "Own.msg" in f.message]
    assert (finding.severity, len(found) == 1) == (severity, severity == WARNING)


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("import Queue", ["queue"]),
        ("from urllib2 import urlopen", ["urllib.request"]),
        ("try:\n    import Queue\nexcept ImportError:\n    import queue as Queue", []),
        ("import queue", []),
    ],
    ids=range(4),
)
def test_a_module_of_python_2(lines, found, tmp_path):
    findings = check_rules.python_findings(tmp_path, f"{lines}\n")
    assert [finding.expected for finding in findings if "Python 2" in finding.message] == found


SCRIPT = "#!/usr/bin/env {}\nimport rospy\nrospy.init_node('a')\n"


def of_any(rule, package, **known):
    given = {"spec": executables.spec(package, check_rules.model_of(package)), **known}
    return check_rules.file_findings(rule, package, **given)


def test_what_runs_messages_is_missed_at_its_own_tag(tmp_path):
    own = "<exec_depend>b</exec_depend>"
    manifest = MANIFEST.replace("<depend>rospy</depend>", f"<!-- {own} -->\n{own}")
    files = {
        "CMakeLists_DOT_txt": f"{CMAKE}\nadd_message_files(FILES A.msg)\n",
        "msg__A_DOT_msg": "",
    }
    package = check_rules.make(tmp_path / "some_pkg", package_DOT_xml=manifest, **files)
    (found,) = [f for f in of_any(messages, package) if "<exec_depend>" in f.message]
    assert package.line("package.xml", found.line).strip() == own


@pytest.mark.parametrize(("ends", "ids"), [(True, ["cmake"]), (False, [])])
def test_a_call_that_cmake_did_not_come_to_may_be_made(ends, ids, tmp_path):
    text = "cmake_minimum_required(VERSION 3.10)\nproject(a)\nfind_package(catkin REQUIRED)\n"
    rest = {"rest_DOT_cmake": "catkin_package()\n"}
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, **rest)
    model = Model(package.root, parsed(text, "CMakeLists.txt"), complete=ends)
    assert [finding.id for finding in of_any(cmake_rule, package, model=model)] == ids


@pytest.mark.parametrize(("name", "number"), [("catkin", 1), ("catkin_simple", 0)])
def test_catkin_simple_finds_what_package_xml_names(name, number, tmp_path):
    text = CMAKE.replace("catkin REQUIRED COMPONENTS roscpp rospy", f"{name} REQUIRED COMPONENTS")
    text += "\nadd_executable(a src/a.cpp)\n"
    source = {"src__a_DOT_cpp": "#include <ros/ros.h>\n"}
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text, **source)
    found = [f for f in of_any(dependencies, package) if "find_package" in f.message]
    assert len(found) == number
