# SPDX-License-Identifier: BSD-3-Clause
"""The pages: what they tell the reader to do works, and prints what they show."""

import json

import pytest
import record_pages
import run_page
from mrp_testing.proves import proves

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("page")]


@pytest.fixture(scope="module")
def shown(site, tmp_path_factory):
    """What they see who do all that the pages say."""
    return run_page.read(run_page.steps(site), tmp_path_factory.mktemp("home"))


@proves(
    "A test types the commands of each box that names a terminal, and compares what they print "
    "with what the box shows.",
    "mkdir -p creates both folders at once.",
    "Two new folders now stand beside src:",
    "devel holds the result, and a file named setup.bash.",
    "This file tells a terminal where your workspace is:",
    "It has an effect on that one terminal only.",
    "This command creates one.",
    "A workspace is a folder with src, build and devel; catkin_make builds it.",
    "Each new terminal needs the line source ~/catkin_ws/devel/setup.bash.",
    "To type source ~/catkin_ws/devel/setup.bash in this terminal.",
    "UInt32 belongs to the package std_msgs, which has types for single values: message_types "
    "lists them.",
    "UInt32() makes a message, and msg.data is its only field.",
    "std_msgs::UInt32 msg; makes a message, and msg.data is its only field.",
    "catkin_create_pkg has made both.",
    "Programs that later lines make go into devel/lib/mrp.",
    "The first line of your own file names python, a program that Debian does not install by "
    "itself.",
    "Your copy has no tests, and it is built without mrp_testing.",
    "ROS does not need it here.",
    "source makes the new package known to this terminal, which you opened before the package was "
    "there.",
    "__name:= gives it another name, because a node called /mrp/subscriber_cpp_node is running "
    "already:",
    "rostopic echo and hz watch messages, rostopic pub sends them, and rosmsg show describes "
    "their type.",
    "rosmsg package lists all types of a package:",
    "Two more subscribers expect a String.",
    "The first messages were already on their way.",
    "Cause: the master is still the same.",
    "The package counts has a message, a C++ program, a script and a module.",
    "Cause: nothing says that the header must be generated before the program is compiled.",
    "Fix: add_dependencies, as above.",
    "Cause: the module src/counts/numbers.py is in no folder in which Python looks.",
    "Fix: the file setup.py, and catkin_python_setup() above generate_messages:",
    "Cause: Python looks into the script's own folder first, and takes the script for the package.",
    "ROS compares these numbers, and not the names alone.",
    "A node with the first definition publishes, and rostopic echo has the second one.",
    "Cause: the two workspaces have different copies of the message.",
    "catkin remembers which workspaces were sourced when CMake last ran for a workspace.",
    "A new terminal that sources only over_ws knows the first workspace, too:",
    "Cause: devel remembers a folder that does not exist.",
    "source says nothing about it.",
    "A setup.bash replaces what an earlier one has set: it brings its own workspace, and those "
    "over which it was built.",
    "add_dependencies for each C++ program that uses a message.",
    "catkin_python_setup() and setup.py for a module; no script with the package's name.",
    "rosmsg md5 with the type, in both terminals.",
    "Cause: each line ends in a carriage return, so the program's name does, too.",
    "Cause: print is a statement in Python 2, and a function in Python 3.",
    "Cause: one line begins with a tab, and its neighbour with spaces.",
    "Cause: Debian has no python2.",
    "Cause: CMake announces that it gives up old versions.",
    "A name with \\r behind it means Windows line ends.",
    "print, except and tabs stop a Python 2 program before it begins.",
    "What you see: seq is not what was set, and nobody has set stamp.",
    "Cause: this terminal does not know where your workspace is.",
    "Cause: Debian has a program python3, and no program python.",
    "Its first line names the right Python, and it runs your file.",
    "Cause: the file has no permission to run.",
    "rosrun works even without it: it starts the script in devel.",
    "Cause: the name in ROS_HOSTNAME does not lead to this machine.",
    "This package meets all of them.",
    "Below the list stands each finding: its file and line, what was expected, what was seen, and "
    "how to fix it.",
    "Where the fix is certain, the report shows it as a diff.",
    "A finding that follows from another one says so, and breaks no requirement by itself.",
    "rosrun mrp_check check PATH checks one package; --class checks a folder of them.",
    "One: the three could not be checked, mostly because the first mistake kept a node from "
    "running.",
    "A test compares the console below with what make run prints, and another one does what the "
    "tutorial's pages say, and compares what that prints.",
)
def test_reader_sees_what_the_pages_show(shown):
    recorded = json.loads((run_page.RECORDED / "outputs.json").read_text())
    assert sorted(shown.outputs) == sorted(recorded), "run make docs-record"
    for name, output in shown.outputs.items():
        found = record_pages.differences(recorded[name], output, shown.printed[name])
        assert found == set(), f"{name}: run make docs-record"


def test_graphs_are_those_in_the_pages(shown):
    assert json.loads((run_page.RECORDED / "graphs.json").read_text()) == shown.graphs


@pytest.mark.quick
def test_a_page_that_writes_files_is_read_before_all_that_build(tmp_path):
    step = {"kind": "file", "path": "a.py", "text": "", "page": "pages/latch", "line": 7}
    with pytest.raises(run_page.StepError, match="latch.rst, line 7.*\n.*one of TUTORIAL"):
        run_page.Reader(tmp_path).do(step)
    assert list(tmp_path.iterdir()) == []


def steps_of(*pages):
    """Return a step of each page, whose output and graph have the page's name."""
    return [
        {"page": f"pages/{page}", "commands": ["ls"], "output": page, "graph": page}
        for page in pages
    ]


@pytest.mark.quick
def test_a_page_needs_the_pages_before_it():
    to_do = steps_of("package", "publisher", "building", "message_types", "latch")
    assert run_page.needed(to_do, "publisher") == ["package", "publisher"]
    assert run_page.needed(to_do, "message_types") == ["message_types"]
    assert run_page.needed(to_do, "latch") == ["message_types", "latch"]
    to_do[-1]["commands"] = ["cd ~/catkin_ws"]
    assert run_page.needed(to_do, "latch") == [*run_page.TUTORIAL, "message_types", "latch"]


@pytest.mark.quick
def test_one_page_is_read_after_those_that_it_needs(tmp_path, monkeypatch):
    monkeypatch.setattr(run_page, "copy_repository", lambda target: None)
    step = {"kind": "terminal", "terminal": "1", "line": 1}
    to_do = [
        {**step, "page": f"pages/{page}", "commands": ["echo " + page], "output": page}
        for page in ("package", "message_types", "queues", "latch")
    ]
    shown = run_page.read(to_do, tmp_path, only="latch")
    assert shown.outputs == {page: [page] for page in ("message_types", "latch")}


@pytest.mark.quick
def test_the_reader_makes_no_folder(tmp_path):
    step = {"kind": "file", "path": "a/b.py", "text": "", "page": "pages/publisher", "line": 7}
    with pytest.raises(run_page.StepError, match="publisher.rst, line 7.*\n.*no page has made the"):
        run_page.Reader(tmp_path).do(step)
    (tmp_path / "a").mkdir()
    run_page.Reader(tmp_path).do(step)
    assert (tmp_path / "a" / "b.py").exists()


@pytest.mark.quick
@pytest.mark.parametrize(
    ("text", "is_shown"),
    [
        ("a: 4$", True),
        ("a: 5", False),
        ("a: (?P<ten>\\d*)4$ ... a: (?P=ten)6$", True),
        ("a: 6$ ... a: 4$", False),
        ("a: 4 ... b: 9", True),
        ("a: 4 ... a: 4", False),
        ("^4", False),
        ("in (?P<one>\\d+)$ ... in (?P=one)$", True),
        ("in (?P<one>\\d+)$ ... in (?!(?P=one)$)", False),
    ],
)
def test_what_a_console_must_show(text, is_shown):
    lines = ["a: 4", "in 77", "b: 9", "a: 6", "in 77"]
    assert run_page.meaning.missing([text], lines) == ([] if is_shown else [text])


def test_a_reader_waits_for_what_a_console_shows_and_says_what_is_left_out(tmp_path):
    step = {"page": "pages/latch", "kind": "terminal", "terminal": "1", "line": 7, "output": "a"}
    # One job: Ctrl-C between the two of a list may end neither.
    going_on = {
        "commands": ["seq 40 | cat - /dev/tty"],
        "until": "3",
        "only": "4$",
        "shows": "^4$ ... ^14$",
    }
    with run_page.Reader(tmp_path) as reader:
        reader.do({**step, **going_on})
        shown = reader.shown.outputs["a"]
        assert shown[:2] == ["4", "14"] and shown[-1].startswith("... ")
        with pytest.raises(run_page.StepError, match="expected .*'15'"):
            reader.do({**step, "commands": ["seq 40"], "only": "4$", "shows": "15"})


@pytest.mark.quick
def test_a_box_says_how_many_lines_it_leaves_out():
    assert run_page.only("a", ["a", "b", "", "a"]) == ["a", "a", "... 2 more lines"]
    assert run_page.only("a", ["a", "b"]) == ["a", "... 1 more line"]
    assert run_page.only("", ["a", "b"]) == ["a", "b"]


@pytest.fixture
def recording():
    """What is recorded of two pages and of one that is no more, and what they show now."""
    recorded = {"latch": ["at 1.5"], "queues": ["at 1.5"], "gone": ["at 1.5"]}, {"latch": 1}
    shown = run_page.Shown()
    shown.outputs = shown.printed = {"latch": ["at 2.5"], "queues": ["none"]}
    shown.graphs = {"latch": 2, "queues": 2}
    return recorded, shown, steps_of("latch", "queues")


@pytest.mark.quick
def test_a_recording_keeps_its_text_if_only_values_have_changed(recording):
    outputs, graphs = record_pages.renewed(*recording)
    assert outputs == {"latch": ["at 1.5"], "queues": ["none"]}
    assert graphs == {"latch": 2, "queues": 2}


@pytest.mark.quick
def test_a_recording_is_renewed_if_it_does_not_show_what_it_must(recording):
    recorded, shown, to_do = recording
    to_do[0]["shows"] = "at 2"
    assert record_pages.renewed(recorded, shown, to_do)[0]["latch"] == ["at 2.5"]


@pytest.mark.quick
def test_a_recording_is_renewed_if_it_does_not_say_what_it_leaves_out(recording):
    recorded, shown, to_do = recording
    shown.outputs = {**shown.outputs, "latch": ["at 2.5", "... 3 more lines"]}
    assert record_pages.renewed(recorded, shown, to_do)[0]["latch"][-1] == "... 3 more lines"
    recorded[0]["latch"].append("... 4 more lines")
    assert record_pages.renewed(recorded, shown, to_do)[0]["latch"][-1] == "... 4 more lines"


@pytest.mark.quick
def test_one_page_alone_is_recorded(recording):
    outputs, graphs = record_pages.renewed(*recording, "queues")
    assert outputs == {"latch": ["at 1.5"], "queues": ["none"], "gone": ["at 1.5"]}
    assert graphs == {"latch": 1, "queues": 2}


@pytest.mark.quick
def test_a_recording_may_have_fewer_lines_of_a_kind():
    assert record_pages.differences(["a 1", "a 2"], ["a 3"], ["a 3", "b"]) == set()
    assert record_pages.differences(["a 1"], ["a 3", "b"], ["a 3", "b"]) == {"b"}
    assert record_pages.differences(["a 1"], ["a 3", "b 1"], ["a 3", "b 1", "c"]) == set()
    assert record_pages.differences(["a 1", "c"], ["a 3"], ["a 3", "b"]) == {"c"}


@pytest.mark.quick
def test_the_number_of_a_process_may_be_small():
    """A machine that has just begun has small ones, and a name of a robot has its number."""
    recorded, shown = "I am /talker_48123_1795518217512", "I am /talker_812_1795518217990"
    assert record_pages.differences([recorded], [shown], [shown]) == set()
    assert record_pages.masked(["/robot_1"]) == {"/robot_1"}
