# SPDX-License-Identifier: BSD-3-Clause
"""What CMake, the compiler and the linker print, in plain words, and the line that is to blame."""

import subprocess
import types

import check_rules
import pytest
from check_rules import MANIFEST
from mrp_check.build import compiler, configuring, cpp_words, linker, stubs
from mrp_check.package import cmake
from mrp_check.package.package import Package
from mrp_check.rules.files import cmake as cmake_rule
from mrp_check.rules.files import targets
from mrp_check.rules.run import compile as compile_rule

pytestmark = pytest.mark.quick

CPP = """#include <ros/ros.h>
int main()
{
  if (true)
  {
    f(std_msgs::UInt32());
  return 0;
}
"""


def test_unbalanced_brace_is_found_by_the_indentation():
    assert cpp_words.unbalanced_brace(CPP.splitlines()) == (5, "}")
    assert cpp_words.unbalanced_brace(CPP.replace("());", "()); }").splitlines()) is None
    assert cpp_words.unbalanced_brace(["}", "// {"]) == (1, "{")
    assert cpp_words.unbalanced_brace(["{", "}", "", "}"]) == (4, "{")
    assert cpp_words.unbalanced_brace(["{", "}", "  return 0;", "}"]) == (2, "{")


@pytest.mark.parametrize(
    ("error", "says"),
    [
        ("‘ros’ has not been declared", "#include <ros/ros.h> is missing"),
        ("‘std_msgs’ has not been declared", "#include <std_msgs/UInt32.h> is missing"),
        ("‘uint32_t’ was not declared in this scope", "#include <cstdint> is missing"),
        ("std_msgs/UInt23.h: No such file or directory", "mean std_msgs/UInt32.h?"),
        (
            "boost/version.h: No such file or directory",
            "called boost/version.hpp",
        ),
        (
            "no matching function for call to ‘ros::NodeHandle::subscribe(const char [2])’",
            "arguments of subscribe() don't fit",
        ),
        (
            "binding reference of type ‘ros::ParameterAdapter<std_msgs::UInt32_<std::allocator<"
            "void> >&>::Parameter’ {aka ‘std_msgs::UInt32_<std::allocator<void> >&’} to ‘const"
            " std_msgs::UInt32_<std::allocator<void> >’ discards qualifiers",
            "a std_msgs::UInt32& that isn't const",
        ),
        ("expected ‘;’ before ‘int’", "a semicolon is missing in it, before int."),
        ("expected ‘;’ after class definition", "the class that ends here needs a semicolon"),
        ("something that nobody has seen before", "something that nobody has seen before"),
    ],
    ids=range(10),
)
def test_compilers_errors_in_plain_words(error, says, tmp_path):
    package = check_rules.make(tmp_path / "src" / "some_pkg", src__a_DOT_cpp=CPP)
    output = (
        f"{package.root}/src/a.cpp:6:5: error: {error}\n{package.root}/src/a.cpp:7:1: error: x\n"
    )
    (problem,) = compiler.problems(output, package.root)
    finding = compiler.finding(package, problem)
    assert (finding.id, finding.file, finding.line) == ("compile", "src/a.cpp", 6)
    assert says in finding.message


@pytest.mark.parametrize(
    ("texts", "found"),
    [
        (["no member named 'range'"], [1]),
        (["has no member named 'range'", "expected ')'", "'a' was not declared"], [1, 2]),
        (["'a' was not declared", "has no member named 'range'"], [1, 2]),
        (["'a' was not declared", "'c' is not a member", "'a' was not declared"], [1, 2]),
        (["'C' was not declared", "'b' was not declared"], [1]),
        (["expected ')'", "'b' was not declared"], [1]),
        (["'C' does not name", "'b' was not declared"], [1]),
    ],
    ids=range(7),
)
def test_an_error_that_no_other_follows_from_hides_none(texts, found, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", src__a_DOT_cpp="C b;\na;\na;\n")
    lines = [f"{package.root}/src/a.cpp:{n}:1: error: {text}" for n, text in enumerate(texts, 1)]
    assert [problem.line for problem in compiler.problems("\n".join(lines), package.root)] == found


def test_a_function_that_returns_nothing_is_found_though_it_compiles(tmp_path):
    text = "bool answer(int &a)\n{\n  a = 1;\n}\nint main() { int a; return answer(a); }\n"
    package = check_rules.make(tmp_path / "src" / "some_pkg", src__a_DOT_cpp=text)
    command = ["g++", "-c", package.root / "src" / "a.cpp", "-o", tmp_path / "a.o"]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    (finding,) = compiler.without_return(package, done.stderr, package.root)
    assert done.returncode == 0
    assert (finding.certainty, finding.file, finding.line) == ("", "src/a.cpp", 4)  # seen


def test_error_in_a_header_of_ros_is_where_the_package_uses_it(tmp_path):
    package = check_rules.make(tmp_path / "src" / "some_pkg", src__a_DOT_cpp=CPP)
    output = (
        "In file included from /usr/include/ros/ros.h:1,\n"
        f"                 from {package.root}/src/a.cpp:1:\n"
        "/usr/include/ros/x.h: In instantiation of ‘void f()’:\n"
        f"{package.root}/src/a.cpp:6:5:   required from here\n"
        "/usr/include/ros/x.h:9:1: error: no type\n"
    )
    (problem,) = compiler.problems(output, package.root)
    assert (problem.file, problem.line) == ("src/a.cpp", 6)


@pytest.mark.parametrize(
    ("template", "words"),
    [
        (
            "CMake Error at /usr/share/catkin/cmake/catkin_package.cmake:302 (message):\n"
            "  Messages depends on unknown pkg: odd_msgs (Missing find_package(odd_msgs?))\n"
            "Call Stack (most recent call first):\n  {root}/CMakeLists.txt:4 (catkin_package)\n",
            "odd_msgs",
        ),
        (
            "CMake Error at some_pkg/CMakeLists.txt:4 (add_dependencies):\n"
            '  The dependency target "some_pkg_gencp" of target "a" does not exist.\n\n',
            "Did you mean some_pkg_gencpp?",
        ),
        (
            "CMake Error at some_pkg/CMakeLists.txt:4 (generate_messages):\n"
            "  Cannot locate message [Point]: unknown package [geometry_msgs] on search\n",
            "uses geometry_msgs/Point, but generate_messages() doesn't name",
        ),
    ],
    ids=range(3),
)
def test_what_cmake_says_in_plain_words(template, words, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg")
    output, model = template.format(root=package.root), check_rules.model_of(package)
    found = configuring.finding(package, output, package.root, model)
    assert (found.file, found.line) == ("CMakeLists.txt", 4)
    assert words in found.message + found.fix + found.seen and "the page" not in found.fix


def test_package_that_this_machine_has_not_is_not_the_students_fault(tmp_path):
    package = check_rules.make(
        tmp_path,
        package_DOT_xml=MANIFEST.replace("</package>", "<depend>cv_bridge</depend></package>"),
    )
    template = 'Could not find a package configuration file provided by "{}" with any of'
    assert stubs.absent(package, template.format("cv_bridge")) == "cv_bridge"
    # Nobody asks for this one, and that one is misspelt.
    assert stubs.absent(package, template.format("tf2")) is None
    assert stubs.absent(package, template.format("rospyy")) is None
    # Without a contract, CMakeLists.txt may ask for more.
    assert stubs.absent(package, template.format("tf2"), is_contract=False) == "tf2"
    assert stubs.absent(package, template.format("nav_msgs"), is_contract=False) == "nav_msgs"
    assert stubs.absent(package, template.format("rospyy"), is_contract=False) is None


def test_definitions_that_this_machine_has_not_are_not_the_students_fault(tmp_path, monkeypatch):
    template = "Cannot locate message [{}] in package [{}] with paths [['/usr/share/x/msg']]"
    for name, files in (("some_msgs", ()), ("own_msgs", ("Num.msg",))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").touch()
        for file in files:
            (tmp_path / name / "msg").mkdir()
            (tmp_path / name / "msg" / file).touch()
    monkeypatch.setattr(configuring.resources, "SHARES", (tmp_path,))
    monkeypatch.setattr(configuring.uses, "SHARES", (tmp_path,))
    configuring.uses.is_installed.cache_clear()
    without = configuring.without_definitions
    assert without(template.format("Goal", "some_msgs")) == "some_msgs"
    assert without(template.format("Nun", "own_msgs")) is None
    assert without(template.format("Goal", "sone_msgs")) is None
    configuring.uses.is_installed.cache_clear()


def test_a_header_that_this_machine_has_not_is_no_misspelt_one(tmp_path, monkeypatch):
    monkeypatch.setattr(cpp_words.uses, "debian_packages", lambda: {"libfar-msgs-dev"})
    package = check_rules.make(tmp_path, src__a_DOT_cpp="#include <far_msgs/Empty.h>\n")
    text = "far_msgs/Empty.h: No such file or directory"
    words = cpp_words.of(package, cpp_words.Problem("src/a.cpp", 1, text, ""))
    assert "Debian package libfar-msgs-dev" in words.said and "std_msgs" not in words.said


@pytest.mark.parametrize(
    ("line", "text", "expected"),
    [
        ("ROS_INF0(x);", "‘ROS_INF0’ was not declared in this scope", "Did you mean ROS_INFO?"),
        ("bind(f, _1);", "‘_1’ was not declared in this scope", "only in boost::placeholders"),
        ("#include <old/No.h>", "old/No.h: No such file or directory", "no header old/No.h"),
        ("", "some_pkg/SpedConfig.h: No such file or directory", "mean some_pkg/SpeedConfig.h?"),
        ("", "some_pkg/SpeedConfig.h: No such file or directory", "generated from Speed.cfg"),
    ],
    ids=range(5),
)
def test_the_compilers_error_has_another_cause(line, text, expected, tmp_path):
    source = f"#include <ros/ros.h>\n{line}\n"
    files = {"srv__Go_DOT_srv": "---\n", "cfg__Speed_DOT_cfg": ""}
    package = check_rules.make(tmp_path, src__a_DOT_cpp=source, **files)
    assert expected in cpp_words.of(package, cpp_words.Problem("src/a.cpp", 2, text, "")).said


def test_a_copy_keeps_a_header_from_being_made(tmp_path):
    files = {"srv__Go_DOT_srv": "---\n", "include__some_pkg__Go_DOT_h": ""}
    package = check_rules.make(tmp_path, src__a_DOT_cpp="\n", **files)
    problem = cpp_words.Problem("src/a.cpp", 1, "some_pkg/Go.h: No such file or directory", "")
    assert "isn't generated from Go.srv" in cpp_words.of(package, problem).said


def test_headers_are_looked_for_where_nothing_is_compiled(tmp_path):
    source = '#include "/home/nobody/a.h"\n#include <far/No.h>\n'
    package = check_rules.make(tmp_path, src__a_DOT_cpp=source, srv__Go_DOT_srv="---\n")
    target = types.SimpleNamespace(sources=["src/a.cpp"])
    model = types.SimpleNamespace(targets={"a": target})
    spec = types.SimpleNamespace(is_contract=False)
    case = types.SimpleNamespace(package=package, model=model, built=None, spec=spec)
    found = check_rules.told(check_rules.of(compile_rule.RULE, case))
    assert found == [("compile", 1)]
    text = 'set(CMAKE_CXX_FLAGS "-std=c++14 -O3")\n' + package.text("CMakeLists.txt")
    (package.root / "CMakeLists.txt").write_text(text)
    case.package = Package(package.root)
    assert ("compile", 1) in check_rules.told(check_rules.of(compile_rule.RULE, case))[1:]


def test_catkin_simple_finds_catkin_and_describes_the_package(tmp_path):
    simple = "find_package(catkin_simple REQUIRED)\ncatkin_simple()\ncs_export()\n"
    text = "cmake_minimum_required(VERSION 3.10)\nproject(some_pkg)\n"
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=text + simple)
    assert not check_rules.file_findings(cmake_rule, package)
    (package.root / "CMakeLists.txt").write_text(text)
    assert len(check_rules.file_findings(cmake_rule, Package(package.root))) == 2


def test_a_second_catkin_package_moves_no_executable(tmp_path):
    target = "add_executable(some src/some.cpp)\n"
    package = check_rules.make(
        tmp_path, CMakeLists_DOT_txt=check_rules.CMAKE + target + "catkin_package()\n"
    )
    assert not check_rules.file_findings(cmake_rule, package)
    text = check_rules.CMAKE.replace("catkin_package(", f"{target}catkin_package(")
    (tmp_path / "CMakeLists.txt").write_text(text)
    (found,) = check_rules.file_findings(cmake_rule, Package(tmp_path))
    assert found.message.startswith("catkin_package() comes after the target some")
    (tmp_path / "CMakeLists.txt").write_text(text.replace("add_executable", "add_library"))
    assert not check_rules.file_findings(cmake_rule, Package(tmp_path))


def test_a_source_that_is_not_there_is_named_without_this_machines_folders(tmp_path):
    """CMake's trace has the whole path of ${CMAKE_CURRENT_SOURCE_DIR}/src/some.cpp."""
    target = f"add_executable(some {tmp_path}/src/sone.cpp)\n"
    package = check_rules.make(
        tmp_path, CMakeLists_DOT_txt=check_rules.CMAKE + target, src__some_DOT_cpp=""
    )
    (finding,) = check_rules.file_findings(targets, package)
    assert finding.fix == "Write src/some.cpp for src/sone.cpp."


def test_an_old_cmake_adds_the_ending_of_a_source(tmp_path):
    text = f"{check_rules.CMAKE}add_executable(some src/some)\n"
    package = check_rules.make(tmp_path, CMakeLists_DOT_txt=text, src__some_DOT_cpp="")
    target = check_rules.model_of(package).targets["some"]
    assert target.sources == ["src/some.cpp"] and not target.missing


def test_a_package_of_which_debian_keeps_the_headers_apart_is_not_here(tmp_path, monkeypatch):
    monkeypatch.setattr(compiler.uses, "SHARES", (tmp_path / "share",))
    monkeypatch.setattr(compiler.uses, "debian_packages", lambda: {"libfar-srvs-dev"})
    compiler.uses.is_installed.cache_clear()
    (tmp_path / "share" / "far_srvs").mkdir(parents=True)
    (tmp_path / "share" / "far_srvs" / "package.xml").touch()
    package = check_rules.make(tmp_path / "some_pkg")
    problem = compiler.Problem("src/a.cpp", 1, "far_srvs/Empty.h: No such file or directory", "")
    assert compiler.absent(package, [problem]) == {"src/a.cpp": "far_srvs"}
    (tmp_path / "include" / "far_srvs").mkdir(parents=True)
    (tmp_path / "include" / "far_srvs" / "Trigger.h").touch()
    assert compiler.absent(package, [problem]) == {}
    compiler.uses.is_installed.cache_clear()


TWO_TARGETS = """
add_executable(one src/one.cpp)
add_executable(other src/other.cpp)
"""
LINKED = """
[ 50%] Building CXX object relay/CMakeFiles/other.dir/src/other.cpp.o
/usr/bin/ld: /usr/lib/x86_64-linux-gnu/Scrt1.o: in function `_start':
(.text+0x17): undefined reference to `main'
collect2: error: ld returned 1 exit status
make[2]: *** [relay/CMakeFiles/one.dir/build.make:146: /tmp/devel/lib/relay/one] Error 1
make[1]: *** [CMakeFiles/Makefile2:200: relay/CMakeFiles/one.dir/all] Error 2
"""


def test_main_is_missing_in_the_target_that_failed(tmp_path):
    (tmp_path / "package.xml").write_text(MANIFEST)
    (tmp_path / "CMakeLists.txt").write_text(TWO_TARGETS)
    package = Package(tmp_path)
    calls = cmake.parsed(TWO_TARGETS, "CMakeLists.txt")
    (found,) = linker.findings(package, LINKED, cmake.Model(tmp_path, calls, complete=True))
    assert found.message.startswith("The target one has no function main")
    assert found.line == 2
