# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt and package.xml: what they say of other packages, and what they say twice."""

import types

import check_rules
import pytest
from mrp_check.code import uses
from mrp_check.contract.finding import ERROR, WARNING
from mrp_check.package import manifest
from mrp_check.package.package import Package
from mrp_check.rules.files import cmake, messages, package_name, targets
from one_source import case, lines_of

pytestmark = pytest.mark.quick

DEPEND = "<depend>std_msgs</depend>"  # in line 11
MADE = "message_generation std_msgs)\nadd_message_files(FILES A.msg)\ngenerate_messages({})"


def known_case(folder, components, tags, **files):
    """Return a case of a C++ node whose two files name those packages."""
    found = f"find_package(catkin REQUIRED COMPONENTS {components}"
    text = check_rules.CMAKE.partition("catkin_install_python")[0]
    text = text.replace("find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs)", found)
    known = case(
        *(folder, "cpp", 'ros::init(argc, argv, "a");'),
        CMakeLists_DOT_txt=text,
        package_DOT_xml=check_rules.MANIFEST.replace(DEPEND, tags),
        **files,
    )
    known.manifest = manifest.parse(known.package)
    return known


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("catkin_package()", [6]),
        ("project(some_pkg)", [6]),
        ("if(A)\ncatkin_package()\nendif()", []),
        ("find_package(tf)", []),
        ("add_executable(a src/b.cpp)\nadd_executable(a src/b.cpp)", [7]),
        ("add_executable(a src/b.cpp)\nadd_executable(b src/b.cpp)", []),
        ("add_executable(${a} b.cpp)\nadd_executable(${a} b.cpp)", []),
    ],
    ids=range(7),
)
def test_what_is_called_once_is_not_called_again(line, found, tmp_path):
    text = f"{check_rules.CMAKE.replace('catkin_install_python', '# ')}{line}\n"
    known = case(tmp_path, "cpp", 'ros::init(argc, argv, "a");', CMakeLists_DOT_txt=text)
    known.model.complete = False
    assert lines_of(cmake, known) == found


@pytest.mark.parametrize(
    ("word", "found"),
    [
        ("${our_EXPORTED_TARGETS}", [6]),
        ("${std_msgs_EXPORTED_TARGETS}", []),
        ("${catkin_EXPORTED_TARGETS}", []),
        ("${${PROJECT_NAME}_EXPORTED_TARGETS}", []),
    ],
    ids=range(4),
)
def test_a_target_waits_for_what_is_found(word, found, tmp_path):
    lines = f"std_msgs)\nadd_executable(a src/a.cpp)\n#\nadd_dependencies(a {word})"
    known = known_case(tmp_path, lines, DEPEND)
    assert lines_of(targets, known, WARNING) == found


@pytest.mark.parametrize(
    ("waits", "found"),
    [("", [4]), ("${catkin_EXPORTED_TARGETS}", []), ("our_msgs_generate_messages_cpp", [])],
    ids=range(3),
)
def test_a_target_waits_for_the_messages_of_the_workspace(waits, found, tmp_path):
    lines = "roscpp our_msgs)\nadd_executable(a src/b.cpp)"
    lines += f"\nadd_dependencies(a {waits})" if waits else ""
    source = "#include <our_msgs/Ours.h>\nint main() {}\n"
    known = known_case(tmp_path, lines, DEPEND, src__b_DOT_cpp=source)
    known.spec = types.SimpleNamespace(**vars(known.spec), messages={}, services={})
    assert lines_of(messages, known, WARNING, ERROR) == found


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
    text = check_rules.MANIFEST.replace("some_pkg", name).replace(DEPEND, f"{DEPEND}{url}")
    known = case(tmp_path, "cpp", 'ros::init(argc, argv, "a");', package_DOT_xml=text)
    known.manifest = manifest.parse(known.package)
    known.model.project = None
    assert uses.is_of_ros(name) == (name == "turtlesim")
    assert lines_of(package_name, known) == found


@pytest.mark.parametrize(("path", "found"), [("src/a", [1]), (".hidden", [])])
def test_a_package_within_another_one_is_not_found(path, found, tmp_path):
    known = case(tmp_path, "py", "")
    (known.package.root / path).mkdir(parents=True)
    (known.package.root / path / "package.xml").write_text(check_rules.MANIFEST)
    known.package = Package(known.package.root)
    known.manifest = manifest.parse(known.package)
    known.model.project = None
    assert lines_of(package_name, known) == found
