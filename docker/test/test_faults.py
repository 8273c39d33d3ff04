# SPDX-License-Identifier: BSD-3-Clause
"""Kills nodes, the network and the master of compose.yaml: what do the containers survive?

The page "In containers" says in words what is asserted here.
"""

import contextlib

import pytest
from containers import (
    Composition,
    compose_commands,
    container,
    docker,
    inspect,
    log,
    wait_for_log,
)
from mrp_testing import contract
from mrp_testing.waiting import wait_until

CPP, PY = contract.SUBSCRIBERS
SECONDS = 10  # that the network is cut


@contextlib.contextmanager
def started():
    """Start the four nodes; yield them once each has received something."""
    with Composition(compose_commands()[0], "compose.yaml") as composition:
        for subscriber in contract.SUBSCRIBERS:
            composition.wait_until_received(subscriber)
        yield composition


@pytest.fixture
def nodes():
    with started() as composition:
        yield composition


@pytest.fixture(scope="module")
def nodes_of_both():
    """The nodes of both tests that cut the network."""
    with started() as composition:
        yield composition


def counts(nodes, subscriber):
    return {p: len(values) for p, values in nodes.received(subscriber).items()}


def wait_for_more(nodes, subscriber, before, more=5):
    """Wait until a subscriber has received `more` values of each publisher than `before`."""
    wait_until(
        lambda: all(n >= before[p] + more for p, n in counts(nodes, subscriber).items()),
        lambda: f"{more} more values at {subscriber.name}: {nodes.received(subscriber)}",
    )


def kill(nodes, service):
    """Kill the process of a container as a crash would: docker's own kill is never restarted."""
    state = inspect(nodes.name(service))["State"]
    image = inspect(nodes.name(service))["Config"]["Image"]
    docker(
        *("run", "--rm", "--pid", "host", "--user", "root", "--network", "none"),
        *("--entrypoint", "bash", image, "-c", f"kill -9 {state['Pid']}"),
    )
    return state["Pid"]


def wait_until_back(nodes, service, pid):
    def back():
        state = inspect(nodes.name(service))["State"]
        return state["Running"] and state["Pid"] not in (0, pid)

    wait_until(back, f"{service} is back")


def test_killed_node_comes_back_and_the_others_miss_nothing(nodes):
    for node in contract.NODES:
        before = {s: counts(nodes, s) for s in contract.SUBSCRIBERS}
        wait_until_back(nodes, node.name, kill(nodes, node.name))
        # Until it was killed, the others heard more.
        back = {s: counts(nodes, s) for s in contract.SUBSCRIBERS}
        for subscriber in contract.SUBSCRIBERS:
            wait_for_more(nodes, subscriber, back[subscriber])
            for publisher, values in nodes.received(subscriber).items():
                since = values[before[subscriber][publisher] - 1 :]
                runs = len(contract.runs(since))
                broken = node in (subscriber, publisher)
                hears = f"{subscriber.name} hears of {publisher.name}"
                assert runs <= (2 if broken else 1), f"{node.name} killed: {hears} {since}"


def cut(nodes, name, clock):
    """Cut a container's network for SECONDS; return what the subscriber `clock` has heard then.

    It hears a value of each publisher every half second: by that the time is measured.
    """
    network = nodes.project + "_default"
    docker("network", "disconnect", network, name)
    wait_for_more(nodes, clock, counts(nodes, clock), more=int(SECONDS / contract.PERIOD))
    heard = nodes.received(clock)
    docker("network", "connect", network, name)
    return heard


def flows_again(received, heard):
    """Say if the last values are in sequence, and five of each publisher are of after the cut."""
    return all(
        sum(v > heard[p][-1] for run in contract.runs(values)[-1:] for v in run) >= 5
        for p, values in received.items()
    )


@pytest.mark.xdist_group("cut")
def test_cut_network_loses_values_only_where_and_while_it_is_cut(nodes_of_both):
    nodes = nodes_of_both
    for subscriber, other in ((CPP, PY), (PY, CPP)):
        before, of_other = counts(nodes, subscriber), counts(nodes, other)
        heard = cut(nodes, nodes.name(subscriber.name), other)
        wait_until(
            lambda: flows_again(nodes.received(subscriber), heard),
            lambda: f"values after the cut: {nodes.received(subscriber)}",
        )
        for publisher, values in nodes.received(subscriber).items():
            values = values[before[publisher] - 1 :]
            assert values == sorted(values)
            lost = sorted({*range(values[0], values[-1], contract.STEP)} - {*values})
            print(f"{subscriber.name}, from {publisher.name}: {len(lost)} lost: {lost}")
            assert lost and lost[0] > values[0], f"{publisher.name}: {values}"
        for publisher, values in nodes.received(other).items():
            values = values[of_other[publisher] - 1 :]
            assert contract.first_fault(values) is None, f"{publisher.name}: {values}"


@pytest.mark.xdist_group("cut")
def test_cut_network_loses_nothing_where_the_queue_has_no_bound(nodes_of_both, image):
    nodes = nodes_of_both
    echo = ("rostopic", "echo", f"{contract.GROUP}/{contract.TOPIC}/data")
    options = (f"--network={nodes.project}_default", "--env=ROS_MASTER_URI=http://master:11311")

    def received(lines):
        values = [int(line) for line in lines if line.isdigit()]
        return {
            p: [v for v in values if contract.publisher_of(v) is p] for p in contract.PUBLISHERS
        }

    with container(image, *echo, options=options) as name:
        wait_for_log(name, lambda lines: all(received(lines).values()))
        heard = cut(nodes, name, CPP)
        lines = wait_for_log(name, lambda lines: flows_again(received(lines), heard))
        for publisher, values in received(lines).items():
            assert contract.first_fault(values) is None, f"{publisher.name}: {values}"


def test_restarted_master_knows_nobody_but_the_flow_goes_on(nodes):
    before = {s: counts(nodes, s) for s in contract.SUBSCRIBERS}
    nodes.compose("restart", "master")
    for subscriber in contract.SUBSCRIBERS:
        wait_for_more(nodes, subscriber, before[subscriber])
        for publisher, values in nodes.received(subscriber).items():
            assert contract.first_fault(values) is None, f"{publisher.name}: {values}"
    wait_until(
        lambda: inspect(nodes.name("master"))["State"]["Health"]["Status"] == "healthy",
        "the master is healthy again",
    )

    # A subscriber that starts now finds no publisher, although both publish.
    nodes.compose("restart", CPP.name)
    silent = len(log(nodes.name(CPP.name)))
    wait_for_more(nodes, PY, counts(nodes, PY))
    texts = [contract.logged_text(line) for line in log(nodes.name(CPP.name))[silent:]]
    assert not any(contract.received_value(CPP, text) for text in texts if text), texts

    # The cure: the publishers register when they start.
    before = counts(nodes, CPP)
    nodes.compose("restart", *(node.name for node in contract.PUBLISHERS))
    wait_for_more(nodes, CPP, before)
