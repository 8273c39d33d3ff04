# SPDX-License-Identifier: BSD-3-Clause
"""Runs the image as a student does."""

import re

import pytest
from containers import (
    container,
    docker,
    enough,
    inspect,
    log,
    new_name,
    received,
    removed,
    run,
    stop,
    values_of,
    wait_for_log,
)
from mrp_testing import contract
from mrp_testing.console import ROSLAUNCH_LINE, check_live
from mrp_testing.process import Process

HARDENED = ("--read-only", "--tmpfs=/tmp", "--cap-drop=ALL", "--network=none")
ENTRYPOINT = "/ros_entrypoint.sh"


@pytest.mark.parametrize("options", [(), HARDENED], ids=["plain", "hardened"])
def test_console_is_live_and_ends_on_ctrl_c(image, options):
    with removed(new_name()) as name:
        with Process("docker", "run", "--rm", "--name", name, *options, image) as process:
            process.wait_for(lambda: enough(process.lines), "values at both subscribers")
            check_live(received(process.lines))
            code = process.stop()
        assert code == 0, str(process)
        assert run("docker", "inspect", name, check=False).returncode != 0, "not removed"
    # In the image roslaunch, too, prints at once, but a line and its end one after the other: what
    # a node prints may come between.
    lines = [part for line in process.lines for part in re.split(r"(?<=.)(?=\[ ?INFO\] \[)", line)]
    for pair, values in received(lines).items():
        assert contract.first_fault(values) is None, f"{pair}: {values}"
    texts = [text for text in map(contract.logged_text, lines) if text]
    for node in contract.NODES:
        assert node.start_line.format(f"{contract.GROUP}/{node.name}") in texts, str(process)
    others = [line for line in lines if not contract.logged_text(line)]
    assert [line for line in others if not ROSLAUNCH_LINE.fullmatch(line)] == []


@pytest.fixture(scope="module")
def running(image):
    with container(image, options=HARDENED) as name:
        wait_for_log(name, enough)
        yield name


@pytest.mark.parametrize(
    ("command", "shown"),
    [
        ("rosnode list", "/mrp/subscriber_cpp_node"),
        ("rosnode ping -c 1 /mrp/publisher_cpp_node", "xmlrpc reply from"),
        ("rostopic echo -n 1 /mrp/great_topic", "data: "),
        ("rostopic info /mrp/great_topic", "Type: std_msgs/UInt32"),
        ("rosmsg show std_msgs/UInt32", "uint32 data"),
        ("rostopic pub -1 /another_topic std_msgs/UInt32 7", "publishing and latching message"),
        ("rosservice list", "/mrp/publisher_cpp_node/get_loggers"),
    ],
)
def test_tools(running, command, shown):
    assert shown in docker("exec", running, ENTRYPOINT, *command.split())


@pytest.mark.parametrize("node", contract.SUBSCRIBERS, ids=lambda node: node.name)
def test_rosrun_is_live_and_ends_on_docker_stop(image, running, node):
    """One more subscriber, alone in a container that shares the other one's network."""
    command = ("rosrun", contract.PACKAGE, node.executable, "__ns:=mrp", "__name:=one_more")
    with container(image, *command, options=(f"--network=container:{running}",)) as name:
        lines = wait_for_log(
            name, lambda lines: all(len(v) >= 2 for v in values_of(node, lines).values())
        )
        # Lines that are held back come 40 at a time.
        assert all(len(values) < 10 for values in values_of(node, lines).values()), lines
        assert stop(name) == 0
        for publisher, values in values_of(node, log(name)).items():
            assert contract.first_fault(values) is None, f"{publisher.name}: {values}"


def test_docker_stop_ends_roslaunch(image):
    with container(image) as name:
        wait_for_log(name, enough)
        assert stop(name) == 0
        assert log(name)[-1].endswith("done"), "\n".join(log(name))


def test_command_gets_its_arguments_is_not_root_and_gives_the_exit_code(image):
    command = ("sh", "-c", 'id -un; printf "%s." "$@"; exit 3', "sh", "--help", "a b")
    done = run("docker", "run", "--rm", image, *command, check=False)
    assert (done.returncode, done.stdout) == (3, "ros\n--help.a b.")


def test_no_port_is_published(running):
    assert not inspect(running)["HostConfig"]["PortBindings"]
    assert not inspect(running)["Config"].get("ExposedPorts")
