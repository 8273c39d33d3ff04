# SPDX-License-Identifier: BSD-3-Clause
"""Reads and compiles the code of the original page: the number in a test's name is the defect's.

test_errata_run.py has what shows only when it runs. The page "Errata" describes both.
"""

import re
import shutil
import subprocess

import pytest
from mrp_testing import scratch
from mrp_testing.errata import NUMBERS, ORIGINAL, PACKAGE, mend
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.slow

PAGE = WORKSPACE / "src" / "mrp" / "doc" / "pages" / "errata.rst"


@pytest.mark.quick
def test_page_has_every_defect():
    """A link can lead to each by its number."""
    terms = re.findall(r"^_`([EP]\d+)`: .+\n {3}\S", PAGE.read_text(), re.MULTILINE)
    assert sorted(terms) == sorted(NUMBERS)


@pytest.fixture
def package(tmp_path):
    """A copy of the original, for one test."""
    return shutil.copytree(ORIGINAL, tmp_path / PACKAGE)


# Python that does not compile.


def syntax_error(path):
    """Return the line at which Python gives up, and what it says."""
    with pytest.raises(SyntaxError) as error:
        compile(path.read_text(), str(path), "exec")
    return error.value.text.strip(), error.value.msg


@pytest.mark.quick
def test_e01_global_with_an_assignment():
    line, message = syntax_error(ORIGINAL / "src" / "publisher_py_node.py")
    assert line == "global this_nodes_namespace = rospy.get_namespace()"
    assert message == "invalid syntax"


@pytest.mark.quick
def test_e02_global_with_an_assignment_of_a_constant():
    line, message = syntax_error(ORIGINAL / "snippets" / "hard_coded_namespace.py")
    assert line == 'global my_global_namespace = "/my_global_namespace"'
    assert message == "invalid syntax"


@pytest.mark.quick
def test_e03_parenthesis_never_closed(package):
    subscriber = package / "src" / "subscriber_py_node.py"
    line, message = syntax_error(subscriber)
    assert line.endswith("str(this_data)")
    assert message == "'(' was never closed"

    # With that mended, the subscriber's next one is the publisher's.
    mend(package, "e03_parenthesis")
    assert syntax_error(subscriber)[0].startswith("global this_nodes_namespace =")


@pytest.mark.quick
def test_e04_comment_of_another_language():
    line, message = syntax_error(ORIGINAL / "snippets" / "timer_callback.py")
    assert line == "// Publish a message"
    assert message == "invalid syntax"


@pytest.mark.quick
def test_e01_e03_nothing_else_keeps_python_from_reading_them(package):
    mend(package, "e01_global", "e03_parenthesis")
    for path in (package / "src").glob("*.py"):
        compile(path.read_text(), str(path), "exec")


# What shows only elsewhere.


@pytest.mark.quick
def test_e12_interpreter_that_debian_has_not(tmp_path):
    """There's no program named python on this PATH, as on Debian."""
    done = subprocess.run(
        [str(ORIGINAL / "src" / "publisher_py_node.py")],
        env={"PATH": str(tmp_path), "LC_ALL": "C"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 127
    # Debian 13's env leaves out its folder.
    assert done.stderr.endswith("env: 'python': No such file or directory\n")


def gxx(source, *options):
    """Compile C++ without a result; return what g++ complains of."""
    return subprocess.run(
        ["g++", "-std=c++17", "-fsyntax-only", "-x", "c++", *options, "-"],
        input=source,
        env={**scratch.environment(), "LC_ALL": "C"},
        capture_output=True,
        text=True,
    ).stderr


def test_e15_catkin_lint_finds_what_is_missing(package, tmp_path):
    done = subprocess.run(
        ["catkin_lint", "--offline", "-W2", str(package)],
        env={**scratch.environment(), "ROS_HOME": str(tmp_path), "LC_ALL": "C"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    assert {
        re.sub(r"^my_robotics_pkg: (CMakeLists\S+: )?", "", line)
        for line in done.stdout.splitlines()
    } == {
        "error: package 'roscpp' must be in CATKIN_DEPENDS in catkin_package()",
        "error: package 'std_msgs' must be in CATKIN_DEPENDS in catkin_package()",
        "warning: target 'publisher_cpp_node' is not installed",
        "warning: target 'subscriber_cpp_node' is not installed",
        "warning: file 'src/publisher_py_node.py' is executable but not installed",
        "warning: file 'src/subscriber_py_node.py' is executable but not installed",
    }


# "Simply replace all occurrences of UInt32 with the desired message type."


def with_type(name):
    """Return the original's C++ subscriber for another type, as it says to make it."""
    return (ORIGINAL / "src" / "subscriber_cpp_node.cpp").read_text().replace("UInt32", name)


@pytest.mark.parametrize("name", ["ColorRGBA", "Empty"])
def test_p06_some_types_have_no_data(name):
    assert "has no member named 'data'" in gxx(with_type(name))


def test_p06_a_string_is_no_number():
    assert "cannot convert" in gxx(with_type("String"))


def test_p06_a_fraction_is_cut_off_without_a_word():
    assert gxx(with_type("Float64"), "-Wall", "-Wextra") == ""
    assert "may change value" in gxx(with_type("Float64"), "-Wfloat-conversion")
