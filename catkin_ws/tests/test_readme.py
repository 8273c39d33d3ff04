# SPDX-License-Identifier: BSD-3-Clause
"""What the README shows, against what happens."""

import csv
import os
import re
import signal

import pytest
import yaml
from front_door import environment, make
from mrp_testing import contract
from mrp_testing.console import ROSLAUNCH_LINE
from mrp_testing.process import Process
from mrp_testing.proves import proves
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.quick

README = (ROOT / "README.md").read_text()
IDLE = 4.0  # seconds: where a node takes longer to compile, other work slows the machine down


def console_block():
    return re.search(r"```console\n(.*?)```", README, re.DOTALL).group(1).splitlines()


def mask(line):
    """Return the line with what differs from run to run (times, process ids, values) as #."""
    return re.sub(r"(?<=\[)[\d.]+(?=\])|(?<=data = )\d+", "#", line)


@proves("make alone prints all targets.")
def test_targets_are_those_of_make():
    printed = make().stdout
    listed = re.findall(r"^\| `(make \S+)` \| (.*) \|$", README, re.MULTILINE)
    targets = re.findall(r"^  (make \S+) +(.*)$", printed, re.MULTILINE)
    assert listed == [target for target in targets if target in listed]
    assert ("make run", dict(targets)["make run"]) in listed


@proves(
    ".ci/run begins on a machine where nothing is installed, and calls targets that the workflow "
    "calls, too.",
)
@pytest.mark.slow
def test_ci_and_the_workflow_call_targets_of_the_list():
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text())
    matrices = [job["strategy"]["matrix"] for job in workflow["jobs"].values()]
    by_workflow = {word for one in matrices for line in one["targets"] for word in line.split()}
    ci = (ROOT / ".ci" / "run").read_text()
    by_ci = set(re.findall(r"^ *(?:part )?make (.+)$", ci, re.MULTILINE))
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^([a-z-]+):", makefile, re.MULTILINE))
    assert by_ci and by_ci - by_workflow == set()
    assert by_workflow - targets == set()


@proves(
    "A test compares the console below with what make run prints, and another one does what the "
    "tutorial's pages say, and compares what that prints.",
    "make run prints roslaunch's own lines, and each line of the nodes as it happens:",
)
def test_console_is_what_make_run_prints():
    block = console_block()
    assert make("build").returncode == 0
    with Process(
        "make", "--no-print-directory", "-C", str(ROOT), "run", env=environment()
    ) as process:
        received = re.compile("received message with data")
        count = sum(1 for line in block if received.search(line))
        process.wait_for(
            lambda: sum(1 for line in list(process.lines) if received.search(line)) >= count,
            "as many values as in the README",
        )
        # Ctrl-C reaches make and all that it runs.
        os.killpg(process.pid, signal.SIGINT)
        process.wait()
    shown = {mask(line) for line in block}
    assert shown - set(map(mask, process.lines)) == set(), str(process)
    # What the README leaves out is roslaunch's heading, and what it says after Ctrl-C.
    left_out = [line for line in process.lines if mask(line) not in shown]
    assert [line for line in left_out if not ROSLAUNCH_LINE.fullmatch(line)] == [], str(process)
    assert process.lines[-1] == "done", str(process)


def test_console_values_are_those_of_the_contract():
    values = {(s, p): [] for s in contract.SUBSCRIBERS for p in contract.PUBLISHERS}
    for text in filter(None, map(contract.logged_text, console_block())):
        for subscriber in contract.SUBSCRIBERS:
            value = contract.received_value(subscriber, text)
            if value is not None:
                values[subscriber, contract.publisher_of(value)].append(value)
    for (_, publisher), seen in values.items():
        assert seen[0] == contract.FIRST_VALUE[publisher]
        assert contract.first_fault(seen) is None


def test_layout_names_folders_that_exist():
    layout = re.search(r"## Layout\n\n```\n(.*?)```", README, re.DOTALL).group(1)
    folders = [line.split()[0] for line in layout.splitlines()]
    assert folders
    assert [folder for folder in folders if not (ROOT / folder).is_dir()] == []


@proves(
    "On a machine that is set up, with idle cores, make test takes 2 min 49 s, and make test-all "
    "takes 11 min 16 s.",
)
def test_times_are_those_of_the_recording():
    """The last commit of own_times.csv whose stages were all recorded, on idle cores."""
    took = {}
    for row in csv.DictReader((WORKSPACE / "own_times.csv").read_text().splitlines()):
        if float(row["node"]) < IDLE:
            took.setdefault(row["commit"], {})[row["stage"]] = float(row["seconds"])
    last = [stages for stages in took.values() if "pytest, slow" in stages][-1]
    quick = sum(last[stage] for stage in ("build", "rostests, quick", "pytest, quick"))
    expected = [divmod(round(seconds), 60) for seconds in (quick, sum(last.values()))]
    shown = re.findall(r"takes\s(\d+) min (\d+) s", README)
    assert [(int(minutes), int(seconds)) for minutes, seconds in shown] == expected


def test_table_of_bare_machines_is_the_recording():
    rows = csv.reader((WORKSPACE / "bare_machines.csv").read_text().splitlines())
    header, *figures = [f"| {' | '.join(row)} |" for row in rows]
    assert "\n".join([header, "| --- | ---: | ---: | ---: | ---: |", *figures]) in README
