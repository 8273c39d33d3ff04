# SPDX-License-Identifier: BSD-3-Clause
"""Compares what the README shows with what happens."""

import os
import re
import signal
import subprocess

import pytest
import yaml
from front_door import environment, make
from mrp_testing import contract
from mrp_testing.console import ROSLAUNCH_LINE, received
from mrp_testing.process import Process
from mrp_testing.workspace import ROOT

pytestmark = pytest.mark.quick

README = (ROOT / "README.md").read_text()


def console_block():
    return re.search(r"```console\n(.*?)```", README, re.DOTALL).group(1).splitlines()


def mask(line):
    """Return the line with what differs from run to run (times, process ids, values) as #.

    roscpp of Debian 14 leaves out the space in [ INFO].
    """
    return re.sub(r"(?<=\[)[\d.]+(?=\])|(?<=data = )\d+", "#", line.replace("[ INFO]", "[INFO]"))


def test_commands_are_targets_of_make():
    targets = re.findall(r"^  (make \S+) ", make("ALL=1").stdout, re.MULTILINE)
    named = set(re.findall(r"^make [a-z-]+|(?<=`)make [a-z-]+", README, re.MULTILINE))
    assert {"make run", "make learn", "make why"} <= named <= {*targets}


def test_commands_for_other_repositories_are_those_of_the_page():
    """But for the addresses and the version, which a release writes into the README alone."""
    of_release = r'(?<=ghcr\.io/)[\w.-]+|(?<=repo: ")[^"]+|(?<=rev: )[\d.]+'
    page = re.sub(of_release, "#", (ROOT / "catkin_ws/src/mrp/doc/pages/ci.rst").read_text())
    part = README[README.index("<details><summary>Check the") : README.index("</details>")]
    commands = "".join(re.findall(r"```\n(.*?)```", part, re.DOTALL)).splitlines()
    assert len(commands) == 5
    for command in commands:
        command = command.removesuffix(" .").replace(", args: [.]", "")
        assert re.sub(of_release, "#", command) in page


def test_pictures_are_there():
    pictures = re.findall(r'(?:src|srcset)="([^"]+)"', README)
    assert pictures
    assert [name for name in pictures if not (ROOT / name).is_file()] == []


@pytest.mark.slow
def test_ci_and_the_workflow_call_targets_of_the_list():
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text())
    matrices = [job["strategy"]["matrix"] for job in workflow["jobs"].values()]
    lines = [line for matrix_ in matrices for line in matrix_.get("targets", [])]
    lines += [job.get("targets", "") for matrix in matrices for job in matrix.get("include", [])]
    by_workflow = {word for line in lines for word in line.split()}
    ci = (ROOT / ".ci" / "run").read_text()
    lines = re.findall(r"^ *(?:part \S+ |\w+=\w+ )?make ([a-z -]+)", ci, re.MULTILINE)
    by_ci = {word for line in lines for word in line.split()}
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^([a-z-]+):", makefile, re.MULTILINE))
    # Each target installs its own packages; CI only does so earlier.
    by_ci = {word for word in by_ci if not word.startswith("packages-")}
    assert by_ci and by_ci - by_workflow == set()
    assert by_workflow - targets == set()


def test_console_is_what_make_run_prints():
    shown = {mask(line) for line in console_block()}
    # The README leaves out what roslaunch says, and each node's first line.
    first = {node.start_line.format(f"{contract.GROUP}/{node.name}") for node in contract.NODES}
    assert make("build").returncode == 0
    with Process(
        "make", "--no-print-directory", "-C", str(ROOT), "run", env=environment()
    ) as process:
        # On a busy machine, one node may have received many values before another one has started.
        # And of a link that is being made, rospy says at the end that it failed.
        process.wait_for(
            lambda: (
                shown <= {mask(line) for line in list(process.lines)}
                and first <= set(map(contract.logged_text, list(process.lines)))
                and all(received(process.lines).values())
            ),
            "all lines that the README shows, each node's first line, and a value on each link",
        )
        # Ctrl-C reaches make and all that it runs.
        os.killpg(process.pid, signal.SIGINT)
        process.wait()
    left_out = [line for line in process.lines if mask(line) not in shown]
    left_out = [line for line in left_out if contract.logged_text(line) not in first]
    assert [line for line in left_out if not ROSLAUNCH_LINE.fullmatch(line)] == [], str(process)
    assert process.lines[-1] == "done", str(process)


def test_run_listens_on_this_machine_alone_unless_told():
    (setting,) = set(re.findall(r"if \[ -z .*?; fi;", make("run", "--dry-run").stdout))
    for given, expected in (
        ({}, "localhost"),
        ({"ROS_HOSTNAME": "robot"}, "robot"),
        ({"ROS_IP": "192.0.2.1"}, ""),
    ):
        env = {"PATH": os.environ["PATH"], **given}
        command = ["bash", "-c", f"{setting} echo $ROS_HOSTNAME"]
        printed = subprocess.run(command, env=env, check=True, stdout=subprocess.PIPE, text=True)
        assert printed.stdout.strip() == expected, given


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
