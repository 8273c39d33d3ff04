# SPDX-License-Identifier: BSD-3-Clause
"""Connects the laptop and the robot of several_hosts/, with right settings and each wrong one."""

import re

import pytest
from containers import FOLDER, Composition, compose_commands, docker, log, run, wait_for_log
from mrp_testing import contract
from mrp_testing.waiting import wait_until

README = (FOLDER / "several_hosts" / "README.md").read_text()
TOPIC = f"{contract.GROUP}/{contract.TOPIC}"
PUBLISHERS = sorted(f"{contract.GROUP}/{node.name}" for node in contract.PUBLISHERS)


def hosts(file="compose.yaml"):
    return Composition(compose_commands()[0], f"several_hosts/{file}")


def ros(hosts, service, *command):
    """Run a command of ROS in the container of a host; return the completed process."""
    return run("docker", "exec", hosts.name(service), "/ros_entrypoint.sh", *command, check=False)


def assert_laptop_hears_robot(hosts):
    for subscriber in contract.SUBSCRIBERS:
        for publisher, values in hosts.wait_until_received(subscriber, "laptop").items():
            assert contract.first_fault(values) is None, f"{publisher.name}: {values}"


def listed_publishers(hosts):
    info = ros(hosts, "laptop", "rostopic", "info", TOPIC).stdout.split("Subscribers:")[0]
    return sorted(re.findall(r"^ \* (\S+)", info, re.MULTILINE))


def test_robot_called_localhost_is_silent_until_mended(monkeypatch):
    monkeypatch.setenv("ROBOT_HOSTNAME", "localhost")
    message = f"connection to [{PUBLISHERS[0]}] failed"
    assert "`ROBOT_HOSTNAME=localhost`" in README and message in README
    with hosts() as two:
        wait_until(lambda: listed_publishers(two) == PUBLISHERS, "the publishers are listed")
        # Ten values are heard on the robot itself ...
        heard = ros(two, "robot", "rostopic", "echo", "-n", "10", f"{TOPIC}/data")
        assert heard.returncode == 0, heard.stdout
        assert message in ros(two, "laptop", "rosnode", "ping", "-c", "1", PUBLISHERS[0]).stdout
        # ... and none on the laptop, where both subscribers run.
        lines = log(two.name("laptop"))
        assert sum("SUBSCRIBER" in line for line in lines) == len(contract.SUBSCRIBERS), lines

        # With the right settings, all is heard; and the publishers' half is on the other host.
        monkeypatch.delenv("ROBOT_HOSTNAME")
        two.compose("up", "--detach")
        assert_laptop_hears_robot(two)
        assert "publisher" not in docker("top", two.name("laptop"))


@pytest.mark.parametrize(
    ("setting", "host", "message"),
    [
        (
            "ROBOT_HOSTNAME=no-such-robot",
            "robot",
            "RLException: Unable to contact my own server at [http://no-such-robot:",
        ),
        (
            "ROBOT_MASTER_URI=http://localhost:11311",
            "robot",
            "roscore/master is not yet running, will wait for it to start",
        ),
        (
            "LAPTOP_HOSTNAME=localhost",
            "laptop",
            "RLException: ERROR: could not contact master [http://laptop:11311]",
        ),
    ],
)
def test_wrong_setting_says(monkeypatch, setting, host, message):
    monkeypatch.setenv(*setting.split("="))
    assert f"`{setting}`" in README and message in README
    with hosts() as two:
        wait_for_log(two.name(host), lambda lines: any(message in line for line in lines))


def test_roslaunch_starts_the_robots_half_over_ssh():
    with hosts("remote.yaml") as two:
        assert_laptop_hears_robot(two)
        assert "publisher" not in docker("top", two.name("laptop"))
        running = docker("top", two.name("robot"))
        assert all(f"/{node.executable} " in running for node in contract.PUBLISHERS), running
        # Ctrl-C on the laptop ends the robot's half, too.
        docker("stop", two.name("laptop"))
        wait_until(
            lambda: "publisher_" not in docker("top", two.name("robot")),
            "the publishers on the robot have ended",
        )
