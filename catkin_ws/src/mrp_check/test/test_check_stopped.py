# SPDX-License-Identifier: BSD-3-Clause
"""The real command on a class and on a package: what hangs, what is no text, and a signal."""

import contextlib
import csv
import os
import signal
import subprocess
import sys
import uuid

import pytest
from check_rules import hand_in
from mrp_check.verdict import check
from mrp_testing.process import processes_with
from mrp_testing.waiting import wait_until

pytestmark = pytest.mark.quick


@pytest.fixture
def seconds():
    """For how long the submission sleeps: a number that no other test on this machine has."""
    return f"10000.{uuid.uuid4().int}"


def hanging(seconds):
    return f"""cmake_minimum_required(VERSION 3.10)
project(some_pkg)
execute_process(COMMAND sleep {seconds})
"""


@contextlib.contextmanager
def command(*arguments):
    """The checker's command, running; whatever becomes of the test, it ends with it."""
    program = "from mrp_check.cli.check import main; main()"
    env = {**os.environ, "PYTHONPATH": ":".join(sys.path)}
    with subprocess.Popen(
        ["/usr/bin/python3", "-c", program, *map(str, arguments)],
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as checker:
        try:
            yield checker
        finally:
            checker.kill()


@pytest.mark.slow
def test_one_that_hangs(tmp_path, seconds):
    """The real command: one submission's CMake never ends, another is an empty folder."""
    hand_in(tmp_path / "class", "anna", hanging(seconds))
    (tmp_path / "class" / "berta").mkdir()
    table = tmp_path / "table.csv"
    page = tmp_path / "table.html"
    by_hand = tmp_path / "hand.csv"
    by_hand.write_text("student,points,reason\nberta,3,I saw it.\n")
    arguments = ("--class", tmp_path / "class", "--timeout", 5, "--csv", table, "--html", page)
    with command(*arguments, "--by-hand", by_hand) as checker:
        output, errors = checker.communicate()
    assert checker.returncode == 1, errors
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert [row["submission"] for row in rows] == ["anna", "berta"]
    assert rows[0]["verdict"] in (check.FINDINGS, check.UNCHECKED)
    assert rows[1]["verdict"] == check.UNCHECKED
    assert (rows[0]["mark"], rows[1]["points"], rows[1]["mark"]) == (rows[0]["points"], "0", "3")
    assert "berta" in output
    assert "2 of 2: " in errors
    assert "berta" in page.read_text()
    assert "no package.xml" in (tmp_path / "class.checked" / "berta.txt").read_text()
    assert not processes_with(seconds)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "number"),
    [(["--class"], signal.SIGTERM), ([], signal.SIGINT)],
    ids=["class", "package"],
)
def test_a_signal_ends_all(tmp_path, monkeypatch, seconds, what, number):
    """What runs at that moment is ended, and nothing is left of it, in no folder either."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setenv("TMPDIR", str(scratch))
    hand_in(tmp_path / "class", "anna", hanging(seconds))
    folder = tmp_path / "class" if what else tmp_path / "class" / "anna"
    with command(*what, folder) as checker:
        wait_until(lambda: processes_with(seconds), "the submission's CMake runs")
        checker.send_signal(number)
        _, errors = checker.communicate()
    assert checker.returncode == 1
    assert "stopped early" in errors
    assert "Traceback" not in errors
    assert [path for folder in scratch.iterdir() for path in folder.iterdir()] == []
    assert not processes_with(seconds)
