# SPDX-License-Identifier: BSD-3-Clause
"""Runs `make new`: what it writes builds, and passes its own test and the checkers.

What it writes for Python alone, test_page.py builds, tests, breaks and checks: a page says so.
What it writes for both languages has all that it writes for C++.
"""

import subprocess

import pytest
import yaml
from front_door import make
from mrp_testing import scratch

FILES = {
    ".github/workflows/check.yml",
    "CMakeLists.txt",
    "README.md",
    "launch/laser_filter.launch",
    "package.xml",
    "test/laser_filter.test",
    "test/test_laser_filter.py",
}
PYTHON = "src/laser_filter_py_node.py"
CPP = "src/laser_filter_cpp_node.cpp"


def new(folder, *arguments, **variables):
    return make("new", f"PKG={folder}", *arguments, **variables)


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("language", "nodes"), [("python", {PYTHON}), ("cpp", {CPP}), ("both", {PYTHON, CPP})]
)
def test_package_is_right_at_once(language, nodes, tmp_path):
    package = tmp_path / "src" / "laser_filter"
    done = new(package, f"LANGUAGE={language}")
    assert done.returncode == 0, done.stdout
    assert files(package) == FILES | nodes
    texts = [(package / name).read_text() for name in FILES | nodes]
    assert [
        word
        for word in ("my_package", "MyPackage", "PACKAGE_PATH", "CHECKER", "|  ")
        for t in texts
        if word in t
    ] == []
    assert f"    make check ANY=1 PKG={package}\n" in (package / "README.md").read_text()
    yaml.safe_load((package / ".github/workflows/check.yml").read_text())
    lint = ("catkin_lint", "--strict", "-W2", "--offline", str(package))
    done = subprocess.run(lint, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.stdout.endswith("checked 1 packages and found 0 problems\n")
    if language != "both":
        return
    # At once: run_tests builds what the test starts.
    printed = scratch.catkin_make(tmp_path, "run_tests")
    results = ("catkin_test_results", str(tmp_path / "build" / "test_results"))
    summary = subprocess.run(results, capture_output=True, text=True).stdout
    assert summary.startswith(f"Summary: {2 * len(nodes)} tests, 0 errors, 0 failures"), printed
    done = make("check", "ANY=1", f"PKG={package}")
    assert done.returncode == 0 and "Errors: 0; warnings: 0" in done.stdout, done.stdout


@pytest.mark.quick
def test_language_of_the_desktop_does_not_count(tmp_path):
    package = tmp_path / "src" / "laser_filter"
    assert new(package, LANGUAGE="de:en").returncode == 0
    assert files(package) == FILES | {PYTHON}


@pytest.mark.quick
@pytest.mark.parametrize(
    ("path", "arguments", "says"),
    [
        ("", (), "expected make new PKG=PATH, such as"),
        ("src/Laser-Filter", (), "expected a name of lowercase letters, digits and single"),
        ("src/a", (), "expected a name of lowercase letters, digits and single"),
        ("src/std_msgs", (), "std_msgs is a package of ROS"),
        ("src/there", (), "/src/there exists already"),
        ("laser_filter", (), "expected a folder in the src of a workspace"),
        ("src/laser_filter", ("LANGUAGE=C++",), "found LANGUAGE=C++"),
        ("src/laser_filter", ("LANGUAGE=",), "expected LANGUAGE=python, cpp or both"),
        ("file/src/laser_filter", (), "cannot write"),
    ],
)
def test_what_it_refuses(path, arguments, says, tmp_path):
    (tmp_path / "src" / "there").mkdir(parents=True)
    (tmp_path / "file").touch()
    before = {*tmp_path.rglob("*")}
    done = new(tmp_path / path if path else "", *arguments)
    assert done.returncode != 0
    assert done.stdout.startswith("error: ") and says in done.stdout.splitlines()[0]
    assert {*tmp_path.rglob("*")} == before
