# SPDX-License-Identifier: BSD-3-Clause
"""Does what the pages say, command by command, and compares what they show."""

import json

import pytest
import record_pages
import run_page

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("page")]


@pytest.fixture(scope="module")
def shown(site, tmp_path_factory):
    """What they see who do all that the pages say."""
    return run_page.read(run_page.steps(site), tmp_path_factory.mktemp("home"))


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
    to_do = steps_of("talk", "listen", "launch", "message_types", "latch")
    assert run_page.needed(to_do, "listen") == ["talk", "listen"]
    assert run_page.needed(to_do, "message_types") == [*run_page.CLONE]
    assert run_page.needed(to_do, "latch") == [*run_page.CLONE, "latch"]
    to_do[-1]["commands"] = ["cd ~/catkin_ws"]
    assert run_page.needed(to_do, "latch") == [*run_page.TUTORIAL, *run_page.CLONE, "latch"]


@pytest.mark.quick
def test_one_page_is_read_after_those_that_it_needs(tmp_path, monkeypatch):
    monkeypatch.setattr(run_page, "copy_repository", lambda target: None)
    step = {"kind": "terminal", "terminal": "1", "line": 1}
    to_do = [
        {**step, "page": f"pages/{page}", "commands": ["echo " + page], "output": page}
        for page in ("talk", "message_types", "queues", "latch")
    ]
    shown = run_page.read(to_do, tmp_path, only="latch")
    assert shown.outputs == {page: [page] for page in ("message_types", "latch")}


@pytest.mark.quick
def test_the_reader_makes_no_folder(tmp_path):
    step = {"kind": "file", "path": "a/b.py", "text": "", "page": "pages/listen", "line": 7}
    with pytest.raises(run_page.StepError, match="listen.rst, line 7.*\n.*no page has made the"):
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
        assert shown[:2] == ["4", "14"] and shown[-1].startswith("[")
        with pytest.raises(run_page.StepError, match="expected .*'15'"):
            reader.do({**step, "commands": ["seq 40"], "only": "4$", "shows": "15"})


@pytest.mark.quick
def test_a_box_says_how_many_lines_it_leaves_out():
    assert run_page.only("a", ["a", "b", "", "a"]) == ["a", "a", "[2 other lines left out]"]
    assert run_page.only("a", ["a", "b"]) == ["a", "[1 other line left out]"]
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
    shown.outputs = {**shown.outputs, "latch": ["at 2.5", "[3 other lines left out]"]}
    assert (
        record_pages.renewed(recorded, shown, to_do)[0]["latch"][-1] == "[3 other lines left out]"
    )
    recorded[0]["latch"].append("[4 other lines left out]")
    assert (
        record_pages.renewed(recorded, shown, to_do)[0]["latch"][-1] == "[4 other lines left out]"
    )


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


@pytest.mark.quick
def test_a_recording_proves_how_many_of_how_many():
    recorded, shown = "All requirements are met: 38 of 38.", "All requirements are met: 37 of 38."
    assert record_pages.differences([recorded], [shown], [shown]) == {recorded, shown}
