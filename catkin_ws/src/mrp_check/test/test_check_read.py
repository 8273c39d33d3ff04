# SPDX-License-Identifier: BSD-3-Clause
"""What the rules for packages without a contract read in the sources' texts; nothing is built."""

import types

import check_rules
import pytest
from check_rules import MANIFEST
from mrp_check.build import configuring
from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind, Place
from mrp_check.confined.seen import LaunchResult, Seen
from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.package.cmake import Model
from mrp_check.rules.files import messages
from mrp_check.rules.run import exceptions

pytestmark = pytest.mark.quick


def test_a_target_that_is_waited_for_and_does_not_exist_is_found_where_cmake_stops(tmp_path):
    package = check_rules.make(tmp_path / "src" / "some_pkg", package_DOT_xml=MANIFEST)
    output = (
        "CMake Error at some_pkg/CMakeLists.txt:4 (add_dependencies):\n"
        '  The dependency target "some_pkg_gencp" of target "a" does not exist.\n\n'
    )
    model = Model(package.root, [], complete=False)
    finding = configuring.finding(package, output, package.root, model)
    assert (finding.file, finding.line) == ("CMakeLists.txt", 4)
    assert "Perhaps some_pkg_gencpp is meant." in finding.message


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("msg/A.msg", "Header header\nint32[] x  # here\nint8 B=3\nC[2] c\nDGoal g\n", None),
        ("msg/A.msg", "std_msgs/String a\nnowhere_msgs/Thing b\n", None),
        ("srv/A.srv", "int32 a\n---\nint32 b\n", None),
        ("action/A.action", "---\n---\nbool done\n", None),
        ("msg/A.msg", "int32 a\nstring\n", "Invalid declaration: string"),
        ("srv/A.srv", "\nint32 1st\n---\n", "1st is not a legal message field name"),
        ("msg/A.msg", "\nint a\n", "Perhaps int32 is meant."),
        ("msg/A.msg", "\nCC a\n", "Perhaps C is meant."),
        ("msg/A.msg", "\nstd_msgs/Strng a\n", "std_msgs has no message Strng. Perhaps String"),
    ],
    ids=range(9),
)
def test_ros_reads_each_line_of_a_definition(name, text, said, tmp_path):
    files = {name: text, "msg/C.msg": "", "action/D.action": "---\n---\n"}
    made = {path.replace(".", "_DOT_"): content for path, content in files.items()}
    package = check_rules.make(tmp_path / "some_pkg", **made)
    model = types.SimpleNamespace(message_files={name})
    known = types.SimpleNamespace(package=package, model=model)
    found = [*check_rules.of(messages.RULE, known, messages.definitions)]
    assert [(one.file, one.line) for one in found] == ([(name, 2)] if said else [])
    assert all(said in one.message for one in found)


def test_a_package_that_generate_messages_does_not_name(tmp_path):
    package = check_rules.make(tmp_path / "some_pkg")
    output = (
        "CMake Error at some_pkg/CMakeLists.txt:4 (generate_messages):\n"
        "  Cannot locate message [Point]: unknown package [geometry_msgs] on search\n  path [{}]\n"
    )
    model = Model(package.root, [], complete=False)
    finding = configuring.finding(package, output, package.root, model)
    assert "uses geometry_msgs/Point, and generate_messages() does not name" in finding.message


@pytest.mark.parametrize(
    ("line", "kind", "time", "other", "found"),
    [
        ("n = int(sys.argv[1])", "ValueError", 1, "even", [NOTE]),
        ("n = int(text)", "ValueError", 1, "even", [ERROR, ERROR]),
        ("n = int(text)", "ValueError", 1, "odd", [WARNING, NOTE]),  # of the same name
        ("n = int(text)", "ValueError", 5.1, "even", [ERROR]),  # it was asked to end by then
        ("n = ask()", "KeyboardInterrupt", 1, "even", [ERROR]),  # that it died
    ],
    ids=range(5),
)
def test_what_a_node_raises_under_roslaunch(line, kind, time, other, found, tmp_path):
    files = {"src__odd_DOT_py": f"{line}\n", "src__b_DOT_py": ""}
    package = check_rules.make(tmp_path / "some_pkg", **files)
    places = types.SimpleNamespace(
        wrong_arguments=lambda lines: None,
        traceback=lambda lines: (("src/odd.py", 1), kind, "no") if kind in lines else None,
        sources=lambda node: ["src/odd.py"],
        of=lambda *given: ("src/odd.py", 1),
    )
    died = "[odd-1] process has died [pid 7, exit code 1, cmd odd.py __name:=odd]."
    lines = [(time, "err", kind), (4, "out", died)]
    seen = LaunchResult(ending="enough", asked=5, lines=lines, seen=Seen())
    launches = [types.SimpleNamespace(nodes={"/odd": "odd"}, file="", seen=seen)]
    named = {"src/odd.py": "odd", "src/b.py": other}
    starts = [Place(file, 1, Kind.INIT, name) for file, name in named.items()]
    known = types.SimpleNamespace(
        package=package,
        facts=Facts(sources={file: [file] for file in named}, places=starts),
        places=places,
        nodes={"odd": types.SimpleNamespace(not_up=[])},
        observed=types.SimpleNamespace(launches=launches),
    )
    assert [
        one.severity
        for one in check_rules.of(exceptions.RULE, known, exceptions.under_launch_files)
    ] == found
