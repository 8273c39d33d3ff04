# SPDX-License-Identifier: BSD-3-Clause
"""Uses names that aren't UTF-8, as old zip programs write them."""

import csv
import dataclasses
import os
import pathlib
import tarfile

import check_rules
import pytest
from mrp_check import sandbox
from mrp_check.classroom import class_table, mail, moodle
from mrp_check.cli import check as command
from mrp_check.contract import spec
from mrp_check.contract.finding import Finding
from mrp_check.contract.verdict import BROKEN, FINDINGS, Report
from mrp_check.package.package import Package
from mrp_check.report import github, json_
from mrp_check.rules.files import text

ODD = os.fsdecode(b"gr\xfc\xdfe")
ANN = "J%FCrgen_12_assignsubmission_file_"
CONTRACT = dataclasses.replace(spec.read(spec.find("pub_sub")), hidden=())
REPORT = Report(
    ODD,
    "An exercise",
    FINDINGS,
    [
        Finding(
            "spin", f"{ODD} never spins.", f"src/{ODD}.py", 3, seen=ODD, fix=ODD, severity="error"
        )
    ],
    {"spin": BROKEN},
    isolation="No sandbox here: bwrap says no.",
    folder=pathlib.Path("/", ODD),
)
OF_CLASS = class_table.Submission(ODD, json_.data(REPORT))


@pytest.mark.quick
@pytest.mark.parametrize("option", command.OF_PACKAGE)
def test_a_report_takes_any_name_and_says_how_the_package_ran(option, tmp_path):
    path = tmp_path / option
    command.write(path, command.OF_PACKAGE[option][1], REPORT, CONTRACT)
    written = path.read_text(encoding="utf-8")
    assert "never spins" in written and REPORT.isolation in written


@pytest.mark.quick
def test_annotations_and_mail_take_any_name():
    for written in (github.text(REPORT), mail.text(OF_CLASS, CONTRACT)):
        assert REPORT.isolation in written
        written.encode()


@pytest.mark.quick
def test_a_file_of_such_a_name_is_left_out_and_said_once(tmp_path):
    package = check_rules.make(tmp_path, src__odd_DOT_py="import rospy\n")
    assert not [f for f in check_rules.file_findings(text, package) if f.severity == "warning"]
    for name in (b"src/gr\xfc\xdfe.py", b"src/\xfc/a.py"):
        path = os.fsencode(tmp_path) + b"/" + name
        os.makedirs(os.path.dirname(path), exist_ok=True)
        pathlib.Path(os.fsdecode(path)).touch()
    package = Package(tmp_path)
    (finding,) = (f for f in check_rules.file_findings(text, package) if f.severity == "warning")
    assert "src/gr%FC%DFe.py, src/%FC/a.py" in finding.message and finding.id == "text"
    assert [file for file in package.files if file.startswith("src/")] == ["src/odd.py"]


@pytest.mark.quick
def test_bubblewrap_s_own_first_line_is_said(monkeypatch, tmp_path):
    program = tmp_path / "bwrap"
    program.write_text("#!/bin/sh\necho 'bwrap: No permissions' >&2\necho more >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    sandbox.bubblewraps_error.cache_clear()
    try:
        assert sandbox.isolation_text() == f"{sandbox.isolation().value} bwrap: No permissions"
        assert sandbox.isolation() is not sandbox.Isolation.NAMESPACES
    finally:
        sandbox.bubblewraps_error.cache_clear()


@pytest.mark.slow
def test_a_class_with_such_names_gets_its_marks(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "class"
    for name in (b"Ann_11_assignsubmission_file_", b"J\xfcrgen_12_assignsubmission_file_"):
        check_rules.hand_in(folder, os.fsdecode(name))
        pathlib.Path(os.fsdecode(os.fsencode(folder) + b"/" + name + b"/gr\xfc.py")).touch()
    with tarfile.open(folder / os.fsdecode(b"Z\xfc.tar"), "w") as tar:
        tar.add(folder / os.fsdecode(name), os.fsdecode(b"p\xfc"))
    written = {option: f"table.{option}" for option in command.OF_CLASS}
    words = [f"--{option}={path}" for option, path in written.items()]
    options = command.parser().parse_args(["--class", str(folder), *words])
    assert command.run(options) == 1
    with open(written["csv"], newline="") as file:
        rows = {row["submission"]: row for row in csv.DictReader(file)}
    assert [*rows] == ["Ann_11_assignsubmission_file_", ANN, "Z%FC.tar"]
    assert len({(row["points"], row["why"]) for row in rows.values()}) == 1
    assert rows[ANN]["points"] != "0"
    assert "gr%FC.py" in (tmp_path / "class.checked" / f"{ANN}.html").read_text()
    with open(written["moodle"], newline="") as file:
        assert "Participant 12" in file.read()
    assert moodle.left_out([class_table.Submission(ANN, {})]) == []
    # Moodle knows a participant by number: who has none is said.
    assert "check: Z%FC.tar isn't in table.moodle: its name has no" in capsys.readouterr().err
