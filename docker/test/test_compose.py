# SPDX-License-Identifier: BSD-3-Clause
"""Runs one container per node, and two robots on one master."""

import re

import pytest
from containers import Composition, compose_commands, docker, inspect, log, run
from mrp_testing import contract

SERVICES = ["master", *(node.name for node in contract.NODES)]


@pytest.fixture(scope="module", params=compose_commands(), ids=" ".join)
def compose(request):
    return request.param


@pytest.fixture(scope="module")
def nodes(compose):
    with Composition(compose, "compose.yaml") as composition:
        yield composition


@pytest.mark.parametrize("subscriber", contract.SUBSCRIBERS, ids=lambda node: node.name)
def test_subscriber_hears_both_publishers(nodes, subscriber):
    for publisher, values in nodes.wait_until_received(subscriber).items():
        assert contract.first_fault(values) is None, f"{publisher.name}: {values}"
    line = subscriber.start_line.format(f"{contract.GROUP}/{subscriber.name}")
    assert line in map(contract.logged_text, log(nodes.name(subscriber.name)))


def test_containers_are_confined(nodes):
    for service in SERVICES:
        state = inspect(nodes.name(service))
        assert list(state["NetworkSettings"]["Networks"]) == [nodes.project + "_default"]
        assert not any(state["NetworkSettings"]["Ports"].values())
        assert state["HostConfig"]["ReadonlyRootfs"], service
        assert state["HostConfig"]["CapDrop"] == ["ALL"], service


NEVER_HEALTHY = """
services:
  master:
    healthcheck:
      test: [CMD, "false"]
      interval: 1s
      retries: 1
"""


def test_health_check_says_if_the_master_answers(nodes):
    master = nodes.name("master")
    assert inspect(master)["State"]["Health"]["Status"] == "healthy"
    _, *check = inspect(master)["Config"]["Healthcheck"]["Test"]
    elsewhere = "--env=ROS_MASTER_URI=http://localhost:1"
    assert run("docker", "exec", master, *check, check=False).returncode == 0
    assert run("docker", "exec", elsewhere, master, *check, check=False).returncode == 1


def test_nodes_wait_for_a_healthy_master(compose, tmp_path):
    (tmp_path / "never.yaml").write_text(NEVER_HEALTHY)
    files = ("compose.yaml", tmp_path / "never.yaml")
    with Composition(compose, *files, services=["master"]) as composition:
        with pytest.raises(AssertionError, match="unhealthy"):
            composition.compose("up", "--detach")
        running = docker(
            "ps", "--quiet", "--filter=label=com.docker.compose.project=" + composition.project
        )
        assert len(running.split()) == 1, "only the master"


def test_stop_and_down_are_clean(nodes):
    """Ends the nodes of the tests above."""
    for subscriber in contract.SUBSCRIBERS:
        nodes.wait_until_received(subscriber, count=1)
    names = {service: nodes.name(service) for service in SERVICES}
    nodes.compose("stop")
    codes = {service: inspect(name)["State"]["ExitCode"] for service, name in names.items()}
    assert codes == dict.fromkeys(SERVICES, 0)
    assert len(nodes.existing()) == len(SERVICES) + 1
    nodes.compose("down")
    assert nodes.existing() == []


def test_two_robots_never_mix():
    """A subscriber hears one even and one odd sequence: another robot's values would break it."""
    with Composition(compose_commands()[0], "two_robots.yaml", services=["robot1"]) as robots:
        for subscriber in contract.SUBSCRIBERS:
            robots.wait_until_received(subscriber, "robot1")
        # The second one begins to count while the first is further on.
        robots.compose("up", "--detach")
        for subscriber in contract.SUBSCRIBERS:
            robots.wait_until_received(subscriber, "robot2")
        for robot in ("robot1", "robot2"):
            for subscriber in contract.SUBSCRIBERS:
                for publisher, values in robots.received(subscriber, robot).items():
                    fault = contract.first_fault(values)
                    assert fault is None, f"{robot}: {publisher.name}: {fault}"
            shown = docker("exec", robots.name(robot), "rostopic", "info", f"/{robot}/great_topic")
            assert sorted(re.findall(r"^ \* (\S+)", shown, re.MULTILINE)) == sorted(
                f"/{robot}/{node.name}" for node in contract.NODES
            )
