# SPDX-License-Identifier: BSD-3-Clause
"""A class at once: one table, and a broken submission never stops the rest."""

import csv
import dataclasses
import html.parser
import os
import pathlib
import re
import threading

import pytest
from check_rules import hand_in
from mrp_check import check
from mrp_check.cli import check as check_command
from mrp_check.cli import classroom
from mrp_check.contract import by_hand, errors, spec
from mrp_check.contract.verdict import unchecked
from mrp_check.report import class_table, json_, moved
from mrp_check.rules import REQUIREMENTS
from mrp_check.student import package
from mrp_testing.proves import proves
from mrp_testing.waiting import DEADLINE

pytestmark = pytest.mark.quick

SPEC_FILE = spec.find("pub_sub")


class Room(classroom.Classroom):
    """A classroom in which a check is no more than a report."""

    def __init__(self, folder, **options):
        self.said, self.checked = [], []
        options = {"progress": self.said.append, **options}
        super().__init__(folder, SPEC_FILE, **options)

    def report_of(self, package_folder, name):
        self.checked.append(name)
        finding = {
            "id": "values",
            "severity": "error",
            "file": "src/a.py",
            "line": 3,
            "message": "publishes <2>",
            "consequence_of": None,
        }
        verdicts = {id_: check.MET for id_ in REQUIREMENTS}
        return {
            "verdict": check.FINDINGS,
            "package": "student_pkg",
            "spec": "s",
            "requirements": {**verdicts, "values": check.BROKEN, "rate": check.UNCHECKED},
            "findings": [finding],
        }

    def verdicts(self):
        return {one.name: one.report["verdict"] for one in self.check()}

    def reason(self, name):
        return {one.name: one.report.get("reason") for one in self.check()}[name]


def test_no_such_folder(tmp_path):
    with pytest.raises(errors.PackageError, match="There is no folder"):
        Room(tmp_path / "nowhere")


def test_no_submission(tmp_path):
    (tmp_path / ".DS_Store").touch()
    with pytest.raises(errors.PackageError, match="one archive, for each student"):
        Room(tmp_path)


def test_each_folder_is_a_submission(tmp_path):
    hand_in(tmp_path / "class", "berta")
    hand_in(tmp_path / "class", "anna")
    room = Room(tmp_path / "class")
    assert room.verdicts() == {"anna": check.FINDINGS, "berta": check.FINDINGS}
    assert sorted(line.split(";")[0].split(": ", 1)[1] for line in room.said) == [
        "anna: findings",
        "berta: findings",
    ]
    assert {line.split(":")[0] for line in room.said} == {"1 of 2", "2 of 2"}


@proves("Several are checked at a time: --jobs says how many.")
@pytest.mark.parametrize("jobs", [1, 3])
def test_jobs_says_how_many_are_checked_at_a_time(tmp_path, jobs):
    """Each check waits until there are so many, and none is one too many."""
    for name in ("anna", "berta", "carl"):
        hand_in(tmp_path / "class", name)
    together, present = threading.Barrier(jobs, timeout=DEADLINE), []

    class Together(Room):
        def report_of(self, package_folder, name):
            present.append(name)
            assert len(present) <= jobs
            together.wait()
            present.remove(name)
            return super().report_of(package_folder, name)

    options = check_command.parser().parse_args(["--class", "class", "--jobs", str(jobs)])
    assert set(Together(tmp_path / "class", jobs=options.jobs).verdicts().values()) == {
        check.FINDINGS
    }


@proves(
    "As each check ends, a line says which others run, and about how many minutes are left.",
)
def test_progress_says_what_runs_and_how_long_it_takes(tmp_path):
    """The check of anna ends while that of berta runs."""
    for name in ("anna", "berta"):
        hand_in(tmp_path / "class", name)
    begun, ended, said = threading.Event(), threading.Event(), []

    def progress(line):
        said.append(line)
        ended.set()

    class OneByOne(Room):
        def report_of(self, package_folder, name):
            if name == "berta":
                begun.set()
            assert (begun if name == "anna" else ended).wait(DEADLINE)
            return super().report_of(package_folder, name)

    OneByOne(tmp_path / "class", progress=progress).check()
    assert re.fullmatch(r"1 of 2: anna: findings; about \d+ min left; now: berta", said[0])
    assert said[1:] == ["2 of 2: berta: findings"]
    assert classroom.minutes_left(seconds=90, ended=3, left=5) == 3


def two_packages(folder):
    hand_in(folder, "one")
    hand_in(folder, "two")


def many_files(folder):
    hand_in(folder.parent, folder.name)
    for number in range(package.MAX_FILES + 1):
        (folder / str(number)).touch()


def deep_folders(folder):
    path = folder
    for _ in range(300):
        path = path / "d"
        path.mkdir(parents=True)


def link_out(folder):
    outside = hand_in(folder.parent.parent, "outside")
    folder.symlink_to(outside)


def loop(folder):
    folder.mkdir(parents=True)
    (folder / "a").symlink_to(folder)


BROKEN = {
    "empty": (lambda folder: folder.mkdir(parents=True), "no package.xml"),
    "two": (two_packages, "more than one package: one, two"),
    "many": (many_files, "has more than"),
    "deep": (deep_folders, "no package.xml"),
    "out": (link_out, "a link out of the class's folder"),
    "loop": (loop, "no package.xml"),
}


@proves("A submission that cannot be checked does not stop the others.")
@pytest.mark.parametrize("kind", BROKEN)
def test_a_broken_submission_does_not_stop_the_rest(tmp_path, kind):
    make, reason = BROKEN[kind]
    hand_in(tmp_path / "class", "anna")
    make(tmp_path / "class" / kind)
    hand_in(tmp_path / "class", "zoe")
    room = Room(tmp_path / "class")
    assert room.verdicts() == {
        "anna": check.FINDINGS,
        kind: check.UNCHECKED,
        "zoe": check.FINDINGS,
    }
    assert reason in room.reason(kind)


def test_links_within_a_submission_lead_nowhere(tmp_path):
    """What a link in a submission leads to is neither read nor copied."""
    made = hand_in(tmp_path / "class", "anna")
    (tmp_path / "secret").write_text("secret")
    (made / "link").symlink_to(tmp_path / "secret")
    os.mkfifo(made / "pipe")
    assert package.Package(made).files == ["CMakeLists.txt", "package.xml"]


@proves(
    "A second call does not check a submission again that has not changed, so after Ctrl-C the "
    "same command goes on where it stopped.",
    "The reports are in ~/submissions.checked.",
)
def test_what_has_not_changed_is_not_checked_again(tmp_path):
    made = hand_in(tmp_path / "class", "anna")
    hand_in(tmp_path / "class", "berta")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "class").rglob("*")}
    assert sorted(run_of(tmp_path)) == ["anna", "berta"]
    assert any((tmp_path / "class.checked").iterdir())
    assert run_of(tmp_path) == []
    assert before == {path: path.stat().st_mtime_ns for path in (tmp_path / "class").rglob("*")}

    (made / "CMakeLists.txt").write_text("# another\n")
    assert run_of(tmp_path) == ["anna"]
    (made / "CMakeLists.txt").chmod(0o755)
    assert run_of(tmp_path) == ["anna"]
    (made / "new.py").touch()
    assert run_of(tmp_path) == ["anna"]
    assert run_of(tmp_path) == []


def run_of(tmp_path):
    room = Room(tmp_path / "class")
    assert {one.report["verdict"] for one in room.check()} == {check.FINDINGS}
    return room.checked


@proves("A change of points, hidden or late costs no check: the points are counted again.")
@pytest.mark.parametrize(
    ("old", "new", "checked"),
    [
        ("nodes:", "# a comment\nnodes:", []),
        ("nodes:", "points: {wrap: 0}\nhidden: [spin]\nlate: {points: 1}\nnodes:", []),
        ("queue: 10", "queue: 11", ["anna"]),
    ],
)
def test_only_another_contract_is_another_check(tmp_path, old, new, checked):
    hand_in(tmp_path / "class", "anna")
    own = tmp_path / "own.yaml"
    own.write_text(pathlib.Path(SPEC_FILE).read_text())
    room = Room(tmp_path / "class")
    room.spec_file = own
    room.check()
    own.write_text(own.read_text().replace(old, new))
    again = Room(tmp_path / "class")
    again.spec_file = own
    again.check()
    assert (room.checked, again.checked) == (["anna"], checked)


def test_what_could_not_be_checked_is_checked_again(tmp_path, monkeypatch):
    hand_in(tmp_path / "class", "anna")
    report = json_.data(unchecked("no master"))
    monkeypatch.setattr(Room, "report_of", lambda self, *_: report)
    assert Room(tmp_path / "class").verdicts() == {"anna": check.UNCHECKED}
    monkeypatch.undo()
    assert Room(tmp_path / "class").verdicts() == {"anna": check.FINDINGS}


def test_an_error_of_the_checker_is_one_submission_s(tmp_path, monkeypatch):
    hand_in(tmp_path / "class", "anna")
    hand_in(tmp_path / "class", "berta")
    original = Room.report_of

    def fail(self, folder, name):
        if name == "anna":
            raise ZeroDivisionError("in the checker")
        return original(self, folder, name)

    monkeypatch.setattr(Room, "report_of", fail)
    room = Room(tmp_path / "class")
    assert room.verdicts() == {"anna": check.UNCHECKED, "berta": check.FINDINGS}
    assert room.reason("anna") == "ZeroDivisionError: in the checker"


@pytest.fixture
def results(tmp_path):
    """The submissions of a class with a formula, and one with a tag, for a name."""
    for name in ("=1+1", "<b>anna"):
        hand_in(tmp_path / "class", name)
    (tmp_path / "class" / "empty").mkdir()
    return Room(tmp_path / "class").check()


@proves(
    "The points come from the spec.",
    "A spec file says what a package must do, and how many points each requirement is worth.",
)
def test_points_come_from_the_spec(results):
    contract = spec.read(SPEC_FILE)
    all_ids = len(REQUIREMENTS)
    of_spec = dataclasses.replace(contract, points={"values": 5, "topic": 2.5})
    by_name = {one.name: one for one in results}
    assert class_table.most(contract) == all_ids
    assert class_table.most(of_spec) == all_ids + 4 + 1.5
    assert by_name["<b>anna"].points(contract) == all_ids - 2
    assert by_name["<b>anna"].points(of_spec) == all_ids - 2 + 1.5
    assert by_name["empty"].points(contract) == 0


@proves(
    "The table has a column for each requirement.",
    "Its line gives the reason.",
)
def test_csv(results):
    rows = list(csv.DictReader(class_table.csv_text(results, spec.read(SPEC_FILE)).splitlines()))
    assert [row["submission"] for row in rows] == ["<b>anna", "'=1+1", "empty"]
    anna, _, empty = rows
    assert (anna["values"], anna["rate"], anna["topic"]) == ("broken", "unchecked", "met")
    assert anna["why"] == "src/a.py:3: publishes <2>"
    assert int(anna["points"]) == int(anna["of"]) - 2
    assert (empty["verdict"], empty["points"], empty["topic"]) == ("unchecked", "0", "unchecked")
    assert "no package.xml" in empty["why"]


class Tags(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.texts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)

    def handle_data(self, data):
        self.texts.append(data)


@proves(
    "The table has a column for each requirement.",
    "The page marks.html shows how often each requirement is not met, and by whom.",
)
def test_html(results, tmp_path):
    page = Tags(class_table.html_text(results, spec.read(SPEC_FILE), tmp_path))
    assert page.tags.count("tr") == 1 + len(results)
    assert page.tags.count("td") == len(results) * (3 + len(REQUIREMENTS))
    assert "b" not in page.tags
    assert "<b>anna" in page.texts
    assert "src/a.py:3: publishes <2>" in page.texts
    assert page.texts.count("✗") == 2
    assert page.texts.count("2 of 3") == 1
    assert [id_ for id_, _ in class_table.broken_in(results)] == ["values"]
    assert REQUIREMENTS["values"].title in map(str.strip, page.texts)


BY_HAND = """student,late_days,maximum,override,reason,by
anna,2,,,,
berta,1,30,35.5,"the demo, too",B. Roe

carl,,20,,,
dora,30,,,,
"""
LATE = dataclasses.replace(spec.read(SPEC_FILE), late=spec.Late(points=2))


def written(folder, text, encoding="utf-8"):
    file = folder / "hand.csv"
    file.write_bytes(text.encode(encoding))
    return file


@proves(
    "student is a submission's name, and each other column or cell can be left out.",
    "override counts instead of the points that were measured; late days take points off, and no "
    "mark is above maximum.",
    "The tables show the points that were measured, what was set by hand, and the mark.",
)
def test_a_person_s_marks_stand_apart_from_what_was_measured(tmp_path):
    for name in ("anna", "berta", "carl", "dora", "zoe"):
        hand_in(tmp_path / "class", name)
    room, most = Room(tmp_path / "class"), class_table.most(LATE)
    file = written(tmp_path, BY_HAND, "utf-8-sig")
    found = by_hand.read(file, [entry.name for entry in room.entries], most, LATE.late)
    results = room.check()
    for one in results:
        one.by_hand = found.get(one.name, one.by_hand)
    measured = most - 2
    marks = {"anna": measured - 4, "berta": 30, "carl": 20, "dora": 0, "zoe": measured}
    rows = list(csv.DictReader(class_table.csv_text(results, LATE).splitlines()))
    assert {row["submission"]: float(row["mark"]) for row in rows} == marks
    assert {float(row["points"]) for row in rows} == {measured}
    assert [row["by_hand"] for row in rows] == [
        "2 days late: -4",
        "points set to 35.5; 1 day late: -2; at most 30 (B. Roe: the demo, too)",
        "at most 20",
        "30 days late: -60",
        "",
    ]
    page = Tags(class_table.html_text(results, LATE, tmp_path))
    assert page.tags.count("td") == len(results) * (5 + len(REQUIREMENTS))
    assert {*rows[1].values()} & {*page.texts} >= {rows[1]["by_hand"], "30"}
    said = class_table.text(results, LATE)
    assert f"anna: mark {marks['anna']} of {most}, by hand: 2 days late: -4" in said
    assert "zoe: mark" not in said


@proves(
    "The contract says what a late day takes off: late: {points: 2}, or late: {percent: 10} of "
    "all points.",
)
def test_late_days_take_points_or_percent():
    assert spec.Late(points=1.5).off(2, 40) == 3
    assert spec.Late(percent=10).off(2, 40) == 8


@proves(
    "A line that names nobody, a number that is none, or an override without a reason is an error.",
)
@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("student\nanna\nana\n", r":3: there is no submission 'ana'\. Did you mean 'anna'\?"),
        ("student,by\nanna,\n,B. Roe\n", r":3: there is no submission ''\."),
        ("student\nanna\nberta\nanna\n", r":4: 'anna' stands twice: see line 2\."),
        ("student,late_days\nanna,two\n", r":2: late_days: expected a number .* found 'two'\."),
        ("student,late_days\nanna,-1\n", r":2: late_days: .* found '-1'\."),
        ("student,late_days\nanna,0.5\n", r":2: late_days: expected whole days; found 0\.5\."),
        ("student,maximum\nanna,nan\n", r":2: maximum: expected a number .* found 'nan'\."),
        ("student,maximum\nanna,41\n", r":2: maximum: expected a number from 0 to 40; found"),
        ("student,override\nanna,3\n", r":2: override is 3, but no reason is given\."),
        ("student,override,reason\n\nanna,'7,x\n", r":3: override: .* found ''7'\."),
        ("student,reason\nanna,a,b\n", r":2: expected 2 cells, .*; found 3\."),
        ("student;maximum\nanna;3\n", r":1: there is no column 'student;maximum'"),
        ("student,maximun\n", r":1: there is no column 'maximun'.* Did you mean 'maximum'\?"),
        ("student,by,by\n", r":1: the column 'by' stands twice\."),
        ("by\nanna\n", r":1: expected the column 'student'; it is missing\."),
        ('student,reason\nanna,"x\ny"\n"berta\n', r":4: this is no valid CSV"),
        ("student\nj\xfcrgen\n", r":2: expected UTF-8 text"),
        ("", r":1: expected a line with the columns: student, late_days"),
    ],
)
def test_a_line_that_cannot_be_used_is_an_error(tmp_path, text, says):
    file = written(tmp_path, text, "latin-1")
    with pytest.raises(errors.CannotCheck) as error:
        by_hand.read(file, ["anna", "berta"], 40, spec.Late(percent=10))
    assert str(error.value).startswith(str(file))
    assert re.search(says, str(error.value)), error.value
    assert "\n" not in str(error.value)


@proves("Then nothing is checked.")
def test_nothing_is_checked_before_the_file_can_be_used(tmp_path, monkeypatch, capsys):
    hand_in(tmp_path / "class", "anna")
    file = written(tmp_path, "student,late_days\nanna,1\n")
    monkeypatch.setattr(classroom.Classroom, "check", lambda room: pytest.fail("it checks"))
    with pytest.raises(SystemExit) as end:
        check_command.main(["--class", str(tmp_path / "class"), "--by-hand", str(file)])
    assert end.value.code == 2
    assert f"{file}:2: late_days is 1, but the contract does not say" in capsys.readouterr().err


def test_a_name_may_be_composed_in_two_ways(tmp_path):
    file = written(tmp_path, "student,maximum\nJ\u00fcrgen,3\n")
    assert by_hand.read(file, ["Ju\u0308rgen"], 40, None)["Ju\u0308rgen"].maximum == 3


def marked(tmp_path, contract, package="", **broken):
    """Return a submission of each name, after its mark has been compared with the last one."""
    results = [
        class_table.Submission(
            name,
            {
                "verdict": check.FINDINGS if ids else check.MET,
                "package": "a_pkg",
                "requirements": {
                    id_: check.BROKEN if id_ in ids else check.MET for id_ in REQUIREMENTS
                },
                "findings": [],
            },
            depends_on={"package": name + package, "contract": "1", "checker": "1"},
        )
        for name, ids in broken.items()
    ]
    moved.compare(tmp_path, results, contract)
    return results


def moves(results):
    return {one.name: one.moved for one in results}


@proves(
    "The tables say whose marks have moved and why, such as 9 of 11 -> 9 of 10: wrap is no longer "
    "required.",
)
def test_who_calls_again_sees_whose_marks_have_moved_and_why(tmp_path):
    contract, all_ = spec.read(SPEC_FILE), len(REQUIREMENTS)
    first = dataclasses.replace(contract, points={"wrap": 3})
    other = dataclasses.replace(contract, points={"wrap": 0, "spin": 3})
    class_ = {"anna": ["wrap", "queue"], "berta": []}
    assert moves(marked(tmp_path, first, **class_)) == {"anna": "", "berta": ""}
    why = "spin is worth 3 now, before 1; wrap is no longer required"
    changed = {
        "anna": f"{all_ - 2} of {all_ + 2} -> {all_} of {all_ + 1}: {why}",
        "berta": f"{all_ + 2} of {all_ + 2} -> {all_ + 1} of {all_ + 1}: {why}",
    }
    assert moves(marked(tmp_path, other, **class_)) == changed
    assert moves(marked(tmp_path, other, **class_)) == changed
    results = marked(tmp_path, other, **class_, carl=[])
    assert moves(results) == {**changed, "carl": ""}

    rows = list(csv.DictReader(class_table.csv_text(results, other).splitlines()))
    assert [row["moved"] for row in rows] == [*changed.values(), ""]
    assert changed["anna"] in Tags(class_table.html_text(results, other, tmp_path)).texts
    assert f"anna: {changed['anna']}" in class_table.text(results, other)


def test_what_a_student_or_a_person_has_changed_moves_a_mark_too(tmp_path):
    contract, all_ = spec.read(SPEC_FILE), len(REQUIREMENTS)
    ids = [*REQUIREMENTS][:8]
    marked(tmp_path, contract, anna=ids, berta=["wrap"])
    found = marked(tmp_path, contract, package="2", anna=[], berta=["wrap"])
    assert moves(found) == {
        "anna": f"{all_ - 8} -> {all_} of {all_}: {', '.join(ids[:5])}, 3 more are met now,"
        " before not met; changed: package",
        "berta": "",
    }
    found[1].by_hand = by_hand.ByHand(maximum=3)
    moved.compare(tmp_path, found, contract)
    assert moves(found) == {
        "anna": "",
        "berta": f"{all_ - 1} -> 3 of {all_}: by hand",
    }
