# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about files: text, manifest, CMake, scripts; broken and alike."""

import dataclasses
import re

import check_rules
import pytest
from check_rules import CMAKE, MANIFEST, file_findings, told
from mrp_check.code import uses
from mrp_check.package import cmake
from mrp_check.package import manifest as manifests
from mrp_check.package.package import Package
from mrp_check.rules.files import cmake as cmake_rule
from mrp_check.rules.files import dependencies, manifest, messages, package_name, targets, text
from one_source import case, lines_of

pytestmark = pytest.mark.quick

NODE = (
    "#!/usr/bin/env python\nimport rospy\nfrom std_msgs.msg import UInt32\nrospy.init_node('a')\n"
)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (NODE.encode(), []),
        ("#!/usr/bin/env python\n# ä\n".encode(), []),
        (b"\xef\xbb\xbf" + NODE.encode(), [("text", 1)]),
        (NODE.replace("\n", "\r\n").encode(), [("text", 1)]),
        (b"#!/usr/bin/env python\n# \xe4\n", [("text", 2)]),
        (b"#!/usr/bin/env python\n# coding: latin-1\n# \xe4\n", []),
        (NODE.encode("utf-16"), [("text", 1)]),
    ],
    ids=range(7),
)
def test_text(content, expected, tmp_path):
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt="", src__odd_DOT_py=content)
    assert told(file_findings(text, package)) == expected


def test_declared_latin1_breaks_what_catkin_install_python_makes(tmp_path):
    content = b"#!/usr/bin/env python\n# coding: latin-1\n# \xe4\n"
    package = check_rules.make(tmp_path, src__odd_DOT_py=content)
    assert told(file_findings(text, package)) == [("text", 3)]


def test_windows_line_ends_of_cpp_are_a_note(tmp_path):
    package = check_rules.make(tmp_path, src__a_DOT_cpp="int main()\r\n{\r\n}\r\n")
    assert told(file_findings(text, package)) == []
    assert told(file_findings(text, package), "note") == [("text", 1)]


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("</name>", "</nam>", 3, "<name> of line 3 is closed by </nam>"),
        ("</description>", "", 5, "<description> is opened"),
        ("</package>", "", 2, "<package> is opened there and not closed"),
        ("<version>0.1.0</version>", "", 2, "version"),
        (' email="someone@some.example"', "", 6, "email"),
        ("<depend>rospy", "<dependd>rospy", 10, "dependd"),
        ("<depend>rospy</depend>", "<run_depend>rospy</run_depend>", 10, "run_depend"),
        ("  <buildtool_depend>catkin</buildtool_depend>\n", "", 8, "catkin"),
        ("buildtool_depend>catkin<", "buildtool_depend>ament_cmake<", 8, "is of ROS 2"),
        ("</description>", "</description> -->", 5, "nothing reads it: -->"),
    ],
    ids=range(10),
)
def test_broken_manifest(old, new, line, says, tmp_path):
    assert MANIFEST.count(old) == 1
    package = check_rules.make(tmp_path, **{"package_DOT_xml": MANIFEST.replace(old, new)})
    findings = file_findings(manifest, package)
    assert told(findings) == [("manifest", line)]
    assert says in findings[0].message


def test_good_manifest(tmp_path):
    package = check_rules.make(tmp_path)
    assert told(file_findings(manifest, package)) == []


def dependency_findings(folder, manifest_text=MANIFEST, cmake_text=CMAKE, **files):
    files = {"src__odd_DOT_py": NODE, "src__a_DOT_cpp": "#include <ros/ros.h>\n", **files}
    cmake_text += "add_executable(a src/a.cpp)\n"
    package = check_rules.make(
        folder, **{"package_DOT_xml": manifest_text, "CMakeLists_DOT_txt": cmake_text}, **files
    )
    return file_findings(dependencies, package)


def test_what_is_declared_is_no_finding(tmp_path):
    assert told(dependency_findings(tmp_path), "error", "warning", "note") == []


def test_missing_dependency_in_the_manifest(tmp_path):
    text_ = MANIFEST.replace("  <depend>rospy</depend>\n", "")
    (finding,) = dependency_findings(tmp_path, text_)
    assert (finding.file, finding.line, finding.severity) == ("package.xml", 9, "error")
    assert "rospy" in finding.message


def test_all_that_is_missing_is_one_finding(tmp_path):
    text_ = re.sub(r"  <depend>(rospy|std_msgs)</depend>\n", "", MANIFEST)
    (finding,) = dependency_findings(tmp_path, text_)
    assert "rospy (used in src/odd.py:2) and std_msgs (used in src/odd.py:3)." in finding.message
    assert finding.change[1].endswith("<depend>rospy</depend>\n  <depend>std_msgs</depend>")


def test_missing_dependency_that_is_not_here_either(tmp_path):
    files = {"src__b_DOT_py": f"from some_other_msgs.msg import Odd\n{NODE}"}
    package = check_rules.make(tmp_path, src__a_DOT_cpp="", **files)
    without = dataclasses.replace(check_rules.PUB_SUB, is_contract=False)
    found = file_findings(dependencies, package, spec=without)
    assert [one.file for one in found if "some_other_msgs" in one.message] == ["package.xml"]
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
    said = [one.message for one in found if one.severity == "warning"]
    assert len(said) == bool(name) and all(f"does not name {name}" in text for text in said)


def test_misspelt_dependency_is_its_own_lines_fault(tmp_path):
    text_ = MANIFEST.replace("<depend>rospy", "<depend>rosppy")
    (finding,) = dependency_findings(tmp_path, text_)
    assert (finding.line, finding.fix) == (10, "Write rospy for rosppy.")


def test_missing_component(tmp_path):
    text_ = CMAKE.replace("COMPONENTS roscpp", "COMPONENTS")
    (finding,) = dependency_findings(tmp_path, cmake_text=text_)
    assert (finding.file, finding.line, finding.severity) == ("CMakeLists.txt", 3, "error")


def test_package_that_nobody_declares_is_the_using_lines_fault(tmp_path):
    source = "#include <ros/ros.h>\n#include <ros/package.h>\n"
    (finding,) = dependency_findings(tmp_path, src__a_DOT_cpp=source)
    assert (finding.file, finding.line) == ("src/a.cpp", 2)
    assert "roslib" in finding.message


@pytest.mark.parametrize(
    "source",
    [
        "#include <ros/ros.h>\n// #include <ros/package.h>\n",
        "#include <ros/ros.h>\n/*\n#include <ros/package.h>\n*/\n",
    ],
    ids=range(2),
)
def test_comment_uses_nothing(source, tmp_path):
    assert told(dependency_findings(tmp_path, src__a_DOT_cpp=source)) == []


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs)\n", "", 2, "find_package"),
        ("catkin_package(CATKIN_DEPENDS roscpp rospy std_msgs)\n", "", 3, "catkin_package"),
        ("catkin_package(", "add_executable(b src/a.cpp)\ncatkin_package(", 5, "comes after"),
        ("catkin_install", "add_executable(b src/aa.cpp)\ncatkin_install", 5, "src/a.cpp is meant"),
        ("catkin_package(", "catkin_package(INCLUDE_DIRS include ", 4, "no such folder"),
    ],
    ids=range(5),
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


@pytest.mark.parametrize(
    ("generator", "configures", "severities"),
    [
        ("message_generation", True, []),
        ("genmsg", True, ["warning"]),
        ("roslib", False, ["error", "error"]),
        ("actionlib_msgs", True, ["warning", "warning"]),
    ],
)
def test_what_makes_messages(generator, configures, severities, tmp_path):
    """actionlib_msgs brings along what makes messages: CMake goes through."""
    text_ = CMAKE.replace(
        "catkin_package", "add_message_files(FILES A.msg)\ngenerate_messages()\n#"
    )
    package = check_rules.make(
        tmp_path,
        package_DOT_xml=MANIFEST.replace(
            "</package>", f"<depend>{generator}</depend><depend>message_runtime</depend></package>"
        ),
        CMakeLists_DOT_txt=text_.replace("roscpp rospy", f"{generator} roscpp rospy"),
        msg__A_DOT_msg="int32 a\n",
    )
    model = check_rules.model_of(package)
    model.complete = configures
    found = file_findings(messages, package, model=model)
    assert [finding.severity for finding in found] == severities


@pytest.mark.parametrize(
    ("finds", "says"),
    [
        ("catkin REQUIRED COMPONENTS std_msgs", ["find_package(catkin ...) does not name"]),
        ("catkin REQUIRED COMPONENTS message_generation std_msgs", []),
        ("catkin_simple REQUIRED", []),
    ],
)
def test_generate_messages_is_known_where_its_package_is_found(finds, says, tmp_path):
    text_ = f"find_package({finds})\ngenerate_messages(DEPENDENCIES std_msgs)\ncatkin_package()\n"
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt=text_)
    found = [finding.message for finding in file_findings(messages, package)]
    assert [message[: len(word)] for message, word in zip(found, says, strict=True)] == says


def test_code_is_made_of_the_messages_of_an_action(tmp_path):
    calls = "add_action_files(FILES Do.action)\ngenerate_messages()\ncatkin_package"
    text_ = CMAKE.replace("catkin_package", calls).replace("rospy", "rospy message_generation", 1)
    made = {f"msg__{name}_DOT_msg": "" for name in ("DoActionGoal", "DoResult", "DoAction", "Do2")}
    package = check_rules.make(
        tmp_path, action__Do_DOT_action="---\n---\n", CMakeLists_DOT_txt=text_, **made
    )
    found = [one.message for one in file_findings(messages, package)]
    assert [text_[: text_.index(".msg")] for text_ in found if ".msg is" in text_] == ["msg/Do2"]


@pytest.mark.parametrize(
    ("folder", "says"),
    [("srv/", []), ("", ["looks for srv/Ask.srv, and the file lies at Ask.srv: CMake stops."])],
)
def test_a_definition_lies_where_cmake_looks_for_it(folder, says, tmp_path):
    makes = "add_service_files(FILES Ask.srv)\ngenerate_messages()\ncatkin_package"
    package = check_rules.make(
        tmp_path,
        package_DOT_xml=MANIFEST.replace(
            "</package>",
            "<depend>message_generation</depend><depend>message_runtime</depend></package>",
        ),
        CMakeLists_DOT_txt=CMAKE.replace("catkin_package", makes).replace(
            "roscpp rospy", "message_generation roscpp rospy"
        ),
        **{f"{folder}Ask.srv".replace("/", "__").replace(".", "_DOT_"): "int32 a\n---\n"},
    )
    found = file_findings(messages, package)
    assert [finding.message.partition("() ")[2] for finding in found] == says


@pytest.mark.parametrize(
    ("without", "file", "says"),
    [
        ("", "", ""),
        ("add_dependencies(a some_pkg_gencpp)\n", "CMakeLists.txt: add_exec", "does not wait"),
        ("generate_messages()\n", "CMakeLists.txt: add_service_files", "never calls generate"),
        ("add_service_files(FILES Ask.srv)\n", "CMakeLists.txt: find_pac", "add_service_files()"),
    ],
)
def test_own_service_is_made_before_it_is_used(without, file, says, tmp_path):
    more = (
        "add_service_files(FILES Ask.srv)\ngenerate_messages()\ncatkin_package()\n"
        "add_executable(a src/a.cpp)\nadd_dependencies(a some_pkg_gencpp)\n"
    )
    text_ = re.sub(r"catkin_package\(.*\n", more.replace(without, ""), CMAKE)
    package = check_rules.make(
        tmp_path,
        package_DOT_xml=MANIFEST.replace(
            "</package>",
            "<depend>message_generation</depend><depend>message_runtime</depend></package>",
        ),
        CMakeLists_DOT_txt=text_.replace("roscpp rospy", "message_generation roscpp rospy"),
        srv__Ask_DOT_srv="---\n",
        src__a_DOT_cpp="#include <some_pkg/AskRequest.h>\n",
    )
    found = [
        f"{one.file}: {package.lines(one.file)[one.line - 1]} {one.message}"
        for one in file_findings(messages, package)
    ]
    assert len(found) == bool(without)
    assert all(one.startswith(file) and says in one for one in found), found


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
    ("name", "url", "found"),
    [
        ("turtlesim", "", [3]),
        ("turtlesim", "<url>http://www.ros.org/turtlesim</url>", []),
        ("our_turtle", "", []),
    ],
    ids=range(3),
)
def test_a_package_is_not_called_like_one_of_ros(name, url, found, tmp_path):
    text = check_rules.MANIFEST.replace("some_pkg", name).replace(
        "<depend>std_msgs</depend>", f"<depend>std_msgs</depend>{url}"
    )
    known = case(tmp_path, "cpp", 'ros::init(argc, argv, "a");', package_DOT_xml=text)
    known.manifest = manifests.parse(known.package)
    known.model.project = None
    assert uses.is_of_ros(name) == (name == "turtlesim")
    assert lines_of(package_name, known) == found


@pytest.mark.parametrize(("path", "found"), [("src/a", [1]), (".hidden", [])])
def test_a_package_within_another_one_is_not_found(path, found, tmp_path):
    known = case(tmp_path, "py", "")
    (known.package.root / path).mkdir(parents=True)
    (known.package.root / path / "package.xml").write_text(MANIFEST)
    known.package = Package(known.package.root)
    known.manifest = manifests.parse(known.package)
    known.model.project = None
    assert lines_of(package_name, known) == found
