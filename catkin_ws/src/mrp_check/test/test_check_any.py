# SPDX-License-Identifier: BSD-3-Clause
"""Checks packages without a contract: reports what fails, at its place, and nothing that works."""

import json
import pathlib
import re
import subprocess
import types
import xml.etree.ElementTree as ElementTree

import any_packages
import check_rules
import jsonschema
import pytest
from check_sets import is_told, shown
from mrp_check import sandbox
from mrp_check.cli import check as command
from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.contract.spec import NodeSpec
from mrp_check.package.package import Package
from mrp_check.report import json_, terminal
from mrp_check.run import observing
from mrp_check.verdict import check
from mrp_testing import scratch

pytestmark = pytest.mark.slow

# (severity, id, file and what stands in the line, what the message says)
FOUND = [
    (ERROR, "launch-file", "launch/broken.launch: <node>", ""),
    (NOTE, "launch-file", "launch/asks.launch: $(arg who)", "'who' arg"),
    (ERROR, "launch-nodes", 'launch/all.launch: "nobody.py"', "no executable of that name"),
    (ERROR, "scripts", "scripts/old.py: env python", "asks for 'python'"),
    (ERROR, "scripts", "scripts/ends.py: #!", "isn't executable"),
    (ERROR, "python-syntax", "scripts/print.py: print", "Missing parentheses"),
    (ERROR, "scripts", "scripts/print.py: env python", "asks for 'python'"),
    (ERROR, "spin", "scripts/ends.py: ", "ends by itself|never calls"),
    (ERROR, "exit", "scripts/stays.py: while True", "doesn't end on Ctrl-C"),
    (ERROR, "topic", 'scripts/near.py: "chater"', "publishes on /chatter|nobody publishes"),
    (ERROR, "type", "scripts/number.py: Int32", "std_msgs/String"),
    (ERROR, "python-names", "scripts/raises.py: message.text", "text"),
    (WARNING, "dependencies", "package.xml: depend", "doesn't name .*std_msgs"),
    (ERROR, "starts", "scripts/near.py: ~limit", r"KeyError: '~limit'\. It dies under"),
    (NOTE, "exit", "scripts/waits.py: wait_for_service", "ROSInterruptException"),
    (NOTE, "starts", "scripts/client.py: ", "exit code 1"),
    (NOTE, "starts", "scripts/indexed.py: sys.argv", "IndexError"),
]
# The same of what works here, or cannot be checked here.
DOUBTED = [
    (WARNING, "dependencies", "package.xml: depend", "doesn't name .*nowhere_msgs"),
    (WARNING, "dependencies", "CMakeLists.txt: find_package", "doesn't name nowhere_msgs"),
    (WARNING, "targets", "CMakeLists.txt: add_dependencies", "no such target"),
    (WARNING, "starts", "src/busy.cpp: /home/", "/home/nobody/table.txt"),
    (WARNING, "starts", "scripts/waves.py: /home/", "/home/nobody/waves.txt"),
    (WARNING, "starts", "launch/busy.launch: /home/", "/home/nobody/map.pgm"),
    (WARNING, "starts", "src/client.cpp: ros::init", "Failed to call the service"),
    (WARNING, "dependencies", "package.xml: depend", "doesn't name .*turtlesim"),
    (WARNING, "scripts", "scripts/tool.py: env python", "asks for 'python'"),
]


VALID = pathlib.Path(__file__).with_name("valid_nodes")


def checked(folder):
    return check.check(Package(folder), None, timeout=300)


def test_what_beginners_write_has_no_error(tmp_path, report_schema):
    report = checked(any_packages.correct(tmp_path / "some_pkg"))
    assert not [f for f in report.findings if f.severity == ERROR], shown(report.findings)
    assert report.verdict == check.MET, report.reason
    assert {"values", "rate", "queue"} <= {*report.left_out}
    text = terminal.text(report, everything=True)
    assert "Left out, because only a contract can say it: " in text
    jsonschema.validate(json.loads(json_.text(report)), report_schema)


def test_what_only_looks_broken_has_no_error():
    """By itself, too, a node has the name and the parameters that its launch file gives."""
    report = checked(VALID)
    found = [f for f in report.findings if f.severity in (ERROR, WARNING)]
    assert not found, shown(found)


def test_each_defect_is_found_at_its_place(tmp_path):
    folder = any_packages.faulty(tmp_path / "some_pkg")
    report = checked(folder)
    missed = [row for row in FOUND if not any(is_told(f, folder, *row) for f in report.findings)]
    assert not missed, f"{missed}\n{shown(report.findings)}"
    errors = [f for f in report.findings if f.severity == ERROR and not f.consequence_of]
    others = [f for f in errors if not any(is_told(f, folder, *row) for row in FOUND)]
    assert not others, shown(others)
    assert not [f for f in report.findings if f.file == "scripts/talker.py"]


def test_what_another_machine_may_have_is_no_error(tmp_path):
    folder = any_packages.doubtful(tmp_path / "some_pkg")
    report = checked(folder)
    missed = [row for row in DOUBTED if not any(is_told(f, folder, *row) for f in report.findings)]
    assert not missed, f"{missed}\n{shown(report.findings)}"
    assert not [f for f in report.findings if f.severity == ERROR], shown(report.findings)
    assert report.verdict == check.MET
    assert "nowhere_msgs (not in Debian)" in report.reason


@pytest.mark.parametrize(
    ("has_cmake", "says"),
    [
        (False, "some_pkg isn't correct: The package has no CMakeLists.txt"),
        (True, "no node of some_pkg ran."),
    ],
    ids=["not_built", "not_run"],
)
def test_no_contract_is_written_from_a_package_that_does_not_work(
    has_cmake, says, tmp_path, monkeypatch, capsys
):
    nothing = check_rules.CMAKE.partition("catkin_install")[0]
    folder = check_rules.make(tmp_path / "some_pkg", CMakeLists_DOT_txt=nothing).root
    if not has_cmake:
        (folder / "CMakeLists.txt").unlink()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        command.main(["--write-contract", "some_pkg"])
    line = capsys.readouterr().err.splitlines()[-1]
    assert ended.value.code == 2
    assert line.startswith(f"check: no contract was written, because {says}"), line
    assert [path.name for path in tmp_path.iterdir()] == ["some_pkg"]
    if has_cmake:
        assert checked(folder).isolation == sandbox.isolation_text("CMake and the compiler")


def test_run_tests_checks_a_package(tmp_path):
    scratch.make(tmp_path, "src/mrp_check")
    any_packages.tested(tmp_path / "src" / "some_pkg")
    found, code = results_of(tmp_path)
    (failed,) = (case for case in found.iter("testcase") if case.find("failure") is not None)
    failure = failed.find("failure")
    line = re.search(r"scripts/ends\.py:(\d+): error", failure.text)
    assert line and code == 1, failure.text


def test_another_package_of_the_workspace_is_not_found(tmp_path):
    check_rules.hand_in(tmp_path, "sibling")
    folder = any_packages.tested(tmp_path / "some_pkg")
    cmake = folder / "CMakeLists.txt"
    cmake.write_text(cmake.read_text().replace("COMPONENTS", "COMPONENTS sibling"))
    report = check.check(Package(folder), None, ("configure",), timeout=300)
    assert report.verdict == check.UNCHECKED
    assert "sibling (not in Debian)" in report.reason


ALONE = """\
cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS roscpp nowhere_msgs)
catkin_package(CATKIN_DEPENDS roscpp nowhere_msgs)
include_directories(${catkin_INCLUDE_DIRS})
foreach(name needs says stays)
  add_executable(${name} src/${name}.cpp)
  target_link_libraries(${name} ${catkin_LIBRARIES})
endforeach()
"""
INIT = '#include <ros/ros.h>\nint main(int argc, char** argv)\n{\n  ros::init(argc, argv, "a");\n'
STAYS = f"{INIT}  ros::NodeHandle n;\n  while (true)\n    ros::Duration(0.1).sleep();\n}}\n"


def test_what_needs_nothing_that_is_missing_is_built_and_run(tmp_path):
    package = check_rules.make(
        tmp_path / "some_pkg",
        package_DOT_xml=check_rules.MANIFEST.replace("std_msgs", "nowhere_msgs"),
        CMakeLists_DOT_txt=ALONE,
        src__needs_DOT_cpp=f"#include <nowhere_msgs/A.h>\n{INIT}}}\n",
        src__says_DOT_cpp=f"{INIT}  ros::spinn();\n}}\n",
        src__stays_DOT_cpp=STAYS,
    )
    report = check.check(package, None, timeout=300)
    found = {(f.id, f.file, f.line) for f in report.findings if f.severity == ERROR}
    right = {("compile", "src/says.cpp", 5), ("exit", "src/stays.cpp", 6)}
    assert found - {("starts", None, None)} == right, shown(report.findings)
    assert report.reason.count("nowhere_msgs (not in Debian)") == 1, report.reason


ADVERTISES = 'ros::Publisher p = n.advertise<some_pkg::Num>("sum", 10);\n  while'
EARLY = "#include <some_pkg/Num.h>\n" + STAYS.replace("while", ADVERTISES)


def test_a_node_runs_though_its_message_was_made_too_late(tmp_path):
    cmake = check_rules.CMAKE.replace("COMPONENTS", "COMPONENTS message_generation std_msgs")
    made = "add_message_files(FILES Num.msg)\ngenerate_messages()\ncatkin_package"
    cmake = cmake.partition("catkin_install")[0].replace("catkin_package", made)
    cmake += "include_directories(${catkin_INCLUDE_DIRS})\nadd_executable(adds src/adds.cpp)\n"
    cmake += "target_link_libraries(adds ${catkin_LIBRARIES})\n"
    files = {"CMakeLists_DOT_txt": cmake, "src__adds_DOT_cpp": EARLY, "msg__Num_DOT_msg": "int8 a"}
    report = checked(check_rules.make(tmp_path / "some_pkg", **files).root)
    found = {(f.severity, f.id) for f in report.findings if f.file != "package.xml"}
    assert {(ERROR, "messages"), (ERROR, "exit")} <= found, shown(report.findings)
    assert not {"compile", "starts"} & {id_ for _, id_ in found}, shown(report.findings)


@pytest.mark.parametrize(("language", "is_taken"), [("cpp", False), ("python", True)])
def test_a_script_is_no_stand_in_for_a_cpp_node(language, is_taken, tmp_path):
    package = check_rules.make(tmp_path / "some_pkg", scripts__talks_DOT_py=check_rules.NODE)
    place = types.SimpleNamespace(package=package, folder=tmp_path, package_folder=package.root)
    node = NodeSpec("talks", language, executable="talks")
    found = observing.executable_of(place, node, None, [])
    assert found == (package.root / "scripts" / "talks.py" if is_taken else None)


def results_of(workspace):
    """Run a workspace's tests; return the checker's results, and what catkin_test_results says."""
    scratch.catkin_make(workspace, "run_tests")
    results = workspace / "build" / "test_results"
    done = subprocess.run(["catkin_test_results", results], capture_output=True)
    return ElementTree.parse(results / "some_pkg" / "mrp_check.xml"), done.returncode
