# SPDX-License-Identifier: BSD-3-Clause
"""ROS's headers as g++ has read them once for many: when they are used, and what stays as it is."""

import os

import check_sets
import pytest
from check_rules import ISOLATIONS
from mrp_check import sandbox
from mrp_check.build import headers
from mrp_check.confined import gcc_headers, variables

NODE = "src/publisher_cpp_node.cpp"
# g++ sees the error in a header of ROS's.
TEMPLATE = """
void hear(std_msgs::UInt32& message) {}
void listen(ros::NodeHandle& node) { ros::Subscriber heard = node.subscribe("a", 1, hear); }
"""


@pytest.mark.quick
@pytest.mark.parametrize(
    ("source", "begins"),
    [
        ("#include <ros/ros.h>\n", True),
        ("// a /* b\n/* #define A\n */\n#include <cstdint>  // c\n# include <ros/ros.h>\n", True),
        ("#include <std_msgs/UInt32.h>\n#include <ros/ros.h>\n", True),
        ("#include <stdint.h>\n#include <boost/bind/bind.hpp>\n#include <ros/ros.h>\n", True),
        ("#include <some_pkg/own.h>\n#include <ros/ros.h>\n", False),
        ("#include <cstdint>\n", False),
        ("#define A 1\n#include <ros/ros.h>\n", False),
        ("#include <curses.h>\n#include <ros/ros.h>\n", False),
        ('#include "own.h"\n#include <ros/ros.h>\n', False),
        ("#ifdef A\n#include <ros/ros.h>\n#endif\n", False),
        ("int main() {}\n#include <ros/ros.h>\n", False),
        ("/* " * 9999, False),
    ],
    ids=range(12),
)
def test_only_what_reads_the_same_after_ros_may_stand_before_it(source, begins):
    assert gcc_headers.begins_with_ros(source.encode()) is begins


@pytest.mark.quick
@pytest.mark.parametrize(
    ("command", "flags"),
    [
        (
            "/usr/bin/c++ -DROS_PACKAGE_NAME=x -DA=1 -I/b -isystem /c -O2 -o d -c e",
            ["-DA=1", "-O2"],
        ),
        ("g++ -std=gnu++17 -Wall -MD -MT a -MF b -o c.o -c e.cpp", ["-std=gnu++17", "-Wall"]),
        ("g++ -fplugin=own.so -o d -c e.cpp", None),
        ("g++ -include own.h -o d -c e.cpp", None),
        ("clang++ -o d -c e.cpp", None),
        ("g++ -o d e.o", None),
    ],
    ids=range(6),
)
def test_flags_are_what_the_headers_depend_on(command, flags):
    assert gcc_headers.flags(command.split()) == flags


@pytest.mark.quick
def test_a_source_that_is_not_there_is_the_compilers_business(tmp_path):
    command = ["g++", "-o", "a.o", "-c", str(tmp_path / "a.cpp")]
    made = tmp_path / gcc_headers.folder_of(gcc_headers.flags(command))
    made.mkdir()
    (made / f"{gcc_headers.NAME}.gch").touch()
    assert gcc_headers.with_headers(command, str(tmp_path)) is command


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """The folder in which the headers are kept."""
    folder = tmp_path / "headers"
    folder.mkdir(mode=0o755)
    monkeypatch.setenv(variables.HEADERS, str(folder))
    return folder


@pytest.fixture
def compiled(tmp_path, open_folders):
    """A function that compiles the tutorial's package with a change of its C++ publisher; it
    returns what is found, the executable, and whether the compiler has read all of ROS's headers
    for it."""
    place, scratch = tmp_path / "package", tmp_path / "scratch"
    check_sets.lay_out("mrp", place)
    correct = (place / NODE).read_text()
    scratch.mkdir(mode=0o711)

    def once(change=lambda text: text):
        (place / NODE).write_text(change(correct))
        report = check_sets.check_tutorial(place, "compile", kept=scratch)
        said = [one.message for one in report.findings]
        if said:
            return said
        (read,) = scratch.rglob("publisher_cpp_node.cpp.o.d")
        (executable,) = scratch.rglob("devel/lib/mrp/publisher_cpp_node")
        return said, executable.read_bytes(), "ros/node_handle.h" in read.read_text()

    return once


@pytest.mark.place
@pytest.mark.slow
@pytest.mark.parametrize("isolation", ISOLATIONS)
def test_second_source_is_compiled_with_the_headers_of_the_first(
    kept, compiled, monkeypatch, isolation
):
    monkeypatch.setattr(sandbox, "isolation", lambda: isolation)
    assert compiled()[::2] == ([], True)
    (made,) = kept.glob(f"*/{gcc_headers.NAME}.gch")
    assert made.stat().st_uid == os.getuid()
    said, executable, reads_all = compiled(lambda text: text + "\n// Once more.\n")
    assert (said, reads_all) == ([], False)
    assert b"ros.mrp\0" in executable  # what the messages of ROS_INFO() are called


@pytest.mark.slow
def test_what_is_wrong_is_found_as_ever(kept, compiled):
    wrong = {
        "ros.h> is missing": lambda text: text.replace("#include <ros/ros.h>\n", ""),
        "line 2 of": lambda text: "#include <ros/ros.h>\nnot C++;\n" + text,
        "takes a std_msgs::UInt32& that isn't const": lambda text: text + TEMPLATE,
    }
    compiled()
    assert list(kept.glob(f"*/{gcc_headers.NAME}.gch"))
    for says, change in wrong.items():
        (finding,) = compiled(change)
        assert says in finding


@pytest.mark.quick
def test_headers_are_made_once_for_each_of_three_sets_of_flags(kept):
    def asked(flag):
        return headers.missing([["g++", flag, "-o", "a.o", "-c", "a.cpp"]])

    assert [asked(flag) for flag in ("-O0", "-O0", "-O1")] == [["-O0"], None, ["-O1"]]
    assert [asked(flag) for flag in ("-O2", "-O3")] == [["-O2"], None]
    assert headers.missing([]) is None
