# SPDX-License-Identifier: BSD-3-Clause
"""What a package says of itself, and what its own definitions are given."""

import types

import check_rules
import pytest
from mrp_check import releases
from mrp_check.code import uses
from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.package import manifest
from mrp_check.rules.files import (
    cmake,
    dependencies,
    messages,
    package_name,
    scripts,
)
from mrp_check.rules.run import compile
from one_source import SPEC, case, lines_of

pytestmark = pytest.mark.quick

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
    known = types.SimpleNamespace(package=package, manifest=manifest.parse(package))
    said = [
        one.expected for one in check_rules.of(dependencies.RULE, known, dependencies.undeclared)
    ]
    assert said == [f"<depend>{found}</depend> in package.xml"] * bool(found)


@pytest.mark.parametrize(("header", "found"), [("yaml-cpp/yaml.h", [1]), ("vector", [])])
def test_a_library_is_named_in_the_manifest(header, found, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_cpp=f"#include <{header}>\n")
    known = types.SimpleNamespace(package=package, manifest=manifest.parse(package))
    assert [
        one.line for one in check_rules.of(dependencies.RULE, known, dependencies.undeclared)
    ] == found


@pytest.mark.parametrize(("name", "found"), [("Some_pkg", [3]), ("2_pkg", [3]), ("some-pkg2", [])])
def test_a_package_has_a_usual_name(name, found, tmp_path):
    text = check_rules.MANIFEST.replace("some_pkg", name)
    known = case(tmp_path, "cpp", INIT, package_DOT_xml=text)
    known.manifest = manifest.parse(known.package)
    known.model.project = None
    assert lines_of(package_name, known) == found


@pytest.mark.parametrize(("version", "found"), [("2.8.3", [1]), ("3.10", []), ("2.8...3.20", [])])
def test_cmakelists_is_not_of_an_old_cmake(version, found, tmp_path):
    known = case(tmp_path, "cpp", INIT, CMakeLists_DOT_txt=MADE_BY_CMAKE.replace("3.10", version))
    assert lines_of(cmake, known) == found


# CMake 3.25 warns of what is older than 2.8.12, CMake 3.31 of what is older than 3.10.
@pytest.mark.parametrize(
    ("version", "release", "found"),
    [
        *[("2.8.12", 12, [1]), ("3.0.2", 12, [1]), ("3.0.2...3.4", 12, [1]), ("3.5", 12, [])],
        *[("3.0.2", 13, []), ("3.0.2...3.5", 12, []), ("3.0.2", None, [1])],
    ],
)
def test_what_only_a_newer_cmake_says_is_a_note(version, release, found, tmp_path, monkeypatch):
    monkeypatch.setattr(releases, "here", lambda: release)
    known = case(tmp_path, "cpp", INIT, CMakeLists_DOT_txt=MADE_BY_CMAKE.replace("3.10", version))
    assert lines_of(cmake, known, NOTE) == found


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
    said = check_rules.file_findings(scripts, package, spec=SPEC)
    assert [one.line for one in said if "own folder" in one.message] == [2] * len(found)


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
    said = (
        "a.h:1:2: error: #error This file requires compiler support for the ISO C++ 2011 standard"
    )
    known.built.output = said
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
    known.manifest = manifest.parse(known.package)
    known.spec = types.SimpleNamespace(**vars(known.spec), messages={}, services={})
    found = [*check_rules.of(messages.RULE, known)]
    (one,) = [one for one in found if "Own.msg" in one.message]
    assert (one.severity, len(found) == 1) == (severity, severity == WARNING)


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
    said = check_rules.python_findings(tmp_path, f"{lines}\n")
    assert [one.expected for one in said if "Python 2" in one.message] == found


@pytest.mark.parametrize("line", ["#!/usr/bin/no_python", "#!no_python", "#!/usr/bin/env python2"])
def test_what_starts_all_the_same_has_a_warning(line, tmp_path):
    text = f"{MADE_BY_CMAKE}catkin_install_python(PROGRAMS scripts/a.py DESTINATION bin)\n"
    known = {"CMakeLists_DOT_txt": text, "scripts__a_DOT_py": f"{line}\nimport rospy\n"}
    package = check_rules.make(tmp_path / "some_pkg", **known)
    said = [one.severity for one in check_rules.file_findings(scripts, package, spec=SPEC)]
    assert said == [WARNING]
