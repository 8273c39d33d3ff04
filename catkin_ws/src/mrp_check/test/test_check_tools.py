# SPDX-License-Identifier: BSD-3-Clause
"""What pylint, catkin_lint and g++ say is said in our words; one of them may be missing."""

import subprocess
import types
from concurrent import futures

import check_rules
import pytest
from mrp_check.build import compiler
from mrp_check.code.facts import Facts
from mrp_check.code.python_source import Source
from mrp_check.contract.errors import NotHere
from mrp_check.package import manifest
from mrp_check.rules.tools import catkin_lint, gcc, pylint

pytestmark = pytest.mark.quick


def run(*command, of=()):
    """Run a tool as it runs in a check, but for the confinement."""
    done = subprocess.run(command, capture_output=True, text=True)
    return types.SimpleNamespace(code=done.returncode, output=done.stdout, errors=done.stderr)


def case(package, **known):
    pool = futures.ThreadPoolExecutor(max_workers=1)
    given = {"manifest": manifest.parse(package), "run": run, "run_once": run, **known}
    given["tool"] = lambda name, *call, **words: pool.submit(*call, **words)
    return types.SimpleNamespace(package=package, package_folder=package.root, **given)


PYTHON = """import rospy
from std_msgs.msg import UInt32


def double(number):
    print(2 * number)


class Node:
    def __init__(self):
        self.publisher = rospy.Publisher("a", UInt32, queue_size=1)
        self.rate = rospy.Rate(10)

    def run(self):
        self.publisher.publsh(3)
        self.rate.sleep(1)
        message = UInt32()
        message.Data = double(3)
        self.pubisher.publish(message)
        self.rate == 3
        rospy.loginfo("%d", 3)
        while not rospy.is_shutdown():
            self.publisher.publish(message)


def half(number):
    if number:
        return number / 2
"""


def python_case(folder, **known):
    package = check_rules.make(folder / "some_pkg", src__odd_DOT_py=PYTHON)
    read = {"src/odd.py": Source("src/odd.py", PYTHON)}
    return case(package, facts=Facts(python=read, relevant=[*read]), **known)


def test_pylint_knows_rospy(tmp_path):
    found = [*pylint.RULE.ask(python_case(tmp_path))]
    assert {(f.line, f.certainty) for f in found} == {
        *((15, "read"), (16, "read"), (18, "read"), (18, "habit"), (19, "read"), (20, "habit")),
        (26, "hint"),
    }
    assert not [f for f in found if not f.expected.startswith("nothing that pylint calls ")]


def test_what_another_rule_has_said_pylint_does_not_repeat(tmp_path):
    case_ = python_case(tmp_path)
    case_.facts.python["src/odd.py"].told.update({15: None, 16: None, 18: None})
    assert [finding.line for finding in pylint.RULE.ask(case_)] == [19, 20, 26]


CMAKE = "project(some_pkg)\nfind_package(catkin REQUIRED COMPONENTS roscpp)\ncatkin_package()\n"


def test_catkin_lint_is_asked_only_of_packages_of_catkins(tmp_path):
    other = check_rules.MANIFEST.replace(">catkin<", ">ament_cmake<")
    package = check_rules.make(tmp_path / "some_pkg", package_DOT_xml=other)
    assert not [*catkin_lint.RULE.ask(case(package))]


def test_catkin_lint_gives_notes(tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=CMAKE)
    found = [*catkin_lint.RULE.ask(case(package))]
    assert {f.certainty for f in found} == {"hint"}
    assert any("passes on" in f.message or "pass on" in f.message for f in found)
    assert any("doesn't look for" in f.message for f in found)


CPP = (
    "#include <cstdio>\nint half(int a)\n{\n  if (a) return a / 2;\n}\n"
    "int main(int argc, char **argv)\n{\n  long much = 3;\n  int a;\n"
    '  printf("%d", much);\n  if (a = argc) half(a);\n  if (argc);\n  argc == a;\n'
    "  unsigned left = 2;\n  while (left >= 0) left -= half(2);\n"
    "  if (argc == 1) half(1); else if (argc == 1) half(2);\n  printf(argv[0]);\n"
    "  if (argc == 2 || (argc == 3 && a == 1)) return 0;\n}\n"
)


def test_what_compiles_and_does_something_else(tmp_path):
    package = check_rules.make(tmp_path / "src" / "some_pkg", src__a_DOT_cpp=CPP)
    command = ["g++", *compiler.DOUBTING.split(), "-c", "-o", str(tmp_path / "a.o")]
    done = run(*command, str(package.root / "src" / "a.cpp"))
    built = types.SimpleNamespace(output=done.errors)
    found = [*gcc.RULE.ask(case(package, built=built))]
    assert {f.certainty for f in found} == {"habit"}
    assert sorted((f.line, f.message.split()[0]) for f in found) == [
        *((5, "On"), (10, "The"), (11, "Perhaps"), (12, "A"), (13, "This"), (15, "This")),
        *((16, "This"), (17, "A")),
    ]


def test_a_tool_that_is_missing_is_said_once(tmp_path, monkeypatch):
    missing = types.SimpleNamespace(
        code=1, output="", errors="/usr/bin/python3: No module named pylint"
    )
    case_ = python_case(tmp_path, run_once=lambda *command, of: missing)
    monkeypatch.setattr(catkin_lint, "search_path", lambda: "/nowhere")
    for rule, package in ((pylint, "pylint"), (catkin_lint, "catkin-lint")):
        with pytest.raises(NotHere, match=f"Debian package {package}"):
            [*rule.RULE.ask(case_)]
