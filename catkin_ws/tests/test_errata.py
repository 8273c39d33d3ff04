# SPDX-License-Identifier: BSD-3-Clause
"""Reads and compiles the code of the original page: the number in a test's name is the defect's.

test_errata_run.py has what shows only when it runs. The page "Errata" describes both.
"""

import ast
import re
import shutil
import subprocess

import pytest
from mrp_testing import contract, scratch
from mrp_testing.errata import NUMBERS, ORIGINAL, PACKAGE, line_of, mend
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


# What makes no difference when run, and what does only elsewhere.


@pytest.mark.quick
def test_e11_semicolon_changes_nothing(package):
    mend(package, "e01_global")
    text = (package / "src" / "publisher_py_node.py").read_text()
    assert "0.5;\n" in text
    assert ast.dump(ast.parse(text)) == ast.dump(ast.parse(text.replace(";\n", "\n")))


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


@pytest.mark.parametrize("node", ["publisher_cpp_node", "subscriber_cpp_node"])
def test_e13_include_is_not_used(node):
    source = (ORIGINAL / "src" / (node + ".cpp")).read_text()
    without = source.replace("#include <ros/package.h>\n", "")
    assert without != source
    assert gxx(without) == ""


def test_e14_uint_is_not_standard():
    line = line_of(ORIGINAL / "src" / "publisher_cpp_node.cpp", "uint counter") + "\n"
    assert "'uint' does not name a type" in gxx("#include <cstdint>\n" + line)
    assert gxx("#include <cstdint>\n" + line.replace("uint", "uint32_t")) == ""


def test_e14_float_holds_half_a_second_but_not_a_tenth():
    line = line_of(ORIGINAL / "src" / "publisher_cpp_node.cpp", "float timer_delta")
    line = "constexpr " + line + '\nstatic_assert(timer_delta_t_in_seconds == {}, "differs");\n'
    assert gxx(line.format(0.5)) == ""
    assert "differs" in gxx(line.replace("0.5", "0.1").format(0.1))
    assert gxx(line.replace("0.5", "0.1").replace("float", "double").format(0.1)) == ""


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


def dropped(path):
    """Return the functions that a script's __init__ calls without keeping what they return.

    rospy.on_shutdown returns nothing: rospy keeps what it is given.
    """
    (init,) = [
        node
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef) and node.name == "__init__"
    ]
    called = [
        ast.unparse(statement.value.func)
        for statement in init.body
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)
    ]
    return [name for name in called if name != "rospy.on_shutdown"]


def test_e16_timer_and_subscriber_are_not_kept(package):
    mend(package, "e01_global", "e03_parenthesis")
    assert dropped(package / "src" / "publisher_py_node.py") == ["rospy.Timer"]
    assert dropped(package / "src" / "subscriber_py_node.py") == ["rospy.Subscriber"]
    for name in ("publisher_py_node.py", "subscriber_py_node.py"):
        assert dropped(WORKSPACE / "src" / contract.PACKAGE / "src" / name) == []


@pytest.mark.quick
def test_e17_indentation_here_is_of_one_width():
    """Python: the lines that begin a statement, as others may be indented more. C++: all lines."""
    sources = scratch.WORKSPACE / "src" / contract.PACKAGE / "src"
    for path in sources.glob("*.py"):
        nodes = ast.walk(ast.parse(path.read_text()))
        begins = {node.col_offset for node in nodes if isinstance(node, ast.stmt)}
        assert begins == {0, 4, 8} or begins == {0, 4}, path.name
    for path in sources.glob("*.cpp"):
        lines = path.read_text().splitlines()
        assert {len(line) - len(line.lstrip(" ")) for line in lines if line} <= {0, 2, 4, 6}, (
            path.name
        )
        assert "\t" not in path.read_text()


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


@pytest.mark.quick
def test_p18_excerpts_here_are_marked_as_what_they_are():
    languages = {"CMakeLists.txt": "cmake", ".launch": "xml", ".py": "python", ".cpp": "cpp"}
    directive = re.compile(
        r"^( *)\.\. (?:excerpt|literalinclude|file):: (\S+)\n((?:\1   :.*\n)+)", re.MULTILINE
    )
    seen = set()
    for page in PAGE.parent.glob("*.rst"):
        for _, file, options in directive.findall(page.read_text()):
            ending = next((language for language in languages if file.endswith(language)), None)
            if ending:
                seen.add(ending)
                assert f":language: {languages[ending]}\n" in options, f"{file} in {page.name}"
    assert seen == set(languages)
