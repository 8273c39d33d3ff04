# SPDX-License-Identifier: BSD-3-Clause
"""make bench: does every message arrive, whatever carries it, and is nothing left running?"""

import os
import signal
import subprocess
import sys
import threading
import uuid

import pytest
import rosgraph
import yaml
from mrp_bench import launches, plans, rounds
from mrp_bench.launched import Console
from mrp_bench.processes import Master, cpu
from mrp_bench.programs import ProgramError, Running
from mrp_bench.ways import LIMITS, WAYS, Way
from mrp_testing.process import Process, processes_with
from mrp_testing.waiting import wait_until
from rospy.impl import tcpros_pubsub

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("plan", [plans.QUICK, plans.FULL])
def test_every_way_is_measured_beside_its_limit(plan):
    assert {step.way for step in plan} <= set(WAYS)
    for step in plan:
        beside = {planned.way for planned in plan if planned.stream[:2] == step.stream[:2]}
        assert {"raw_cpp", "raw_py"} <= beside, step
    assert len({(step.way, *step.stream[:2]) for step in plan}) == len(plan), (
        "something is there twice"
    )


def test_full_plan_has_every_way():
    assert {step.way for step in plans.FULL} == set(WAYS)
    assert len(plans.QUICK) < len(plans.FULL)


@pytest.fixture
def master(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", os.environ.get("ROS_MASTER_URI", ""))
    with Master(tmp_path / "master.log"):
        yield


@pytest.mark.slow
def test_every_way_delivers_every_message_in_order(master, tmp_path):
    plan = rounds.steps(WAYS, (8, 200, 10))
    plan += rounds.steps(WAYS, (70000, 0, 3))
    results = rounds.Results(tmp_path)
    rounds.run(plan, 1, results, print)
    found = results.measurements()
    assert len(found) == len(plan)
    for measurement in found:
        assert len(measurement["received"]) == WAYS[measurement["way"]].receivers
        for pairs in measurement["received"]:
            assert pairs[::2] == measurement["sent"], measurement["way"]
            assert all(arrival > stamp for stamp, arrival in zip(pairs[::2], pairs[1::2]))
        assert measurement["sender_cpu"] > 0
        assert WAYS[measurement["way"]].receiver is None or measurement["receiver_cpu"] > 0


@pytest.mark.slow
def test_ways_are_measured_in_turns(tmp_path):
    results, lines = rounds.Results(tmp_path), []
    rounds.run(rounds.steps(LIMITS, (8, 200, 10), (70000, 0, 3)), 4, results, lines.append)
    steps = [line for line in lines if line.startswith("[")]
    assert [line.split(" of 4")[0][-1] for line in steps] == [*"1111222233334444"]
    assert [line.split(": ")[1].split(",")[0] for line in steps] == [*LIMITS] * 8
    assert all(line.endswith(" s left") for line in steps)
    assert steps[-1].startswith("[16/16] round 4 of 4: raw_py, 68 kB as fast as it goes")
    assert len(results.measurements()) == 16


@pytest.mark.slow
def test_program_that_ends_is_an_error(tmp_path, monkeypatch):
    ends = Way("ends", "ends", ("bench_raw", "send=1"), ("bench_raw.py", "receive=1"))
    monkeypatch.setitem(WAYS, "ends", ends)
    results = rounds.Results(tmp_path)

    class Broken(rounds.Running):
        def measure(self, stream):
            self.sender.signal(signal.SIGKILL)
            return super().measure(stream)

    monkeypatch.setattr(rounds, "Running", Broken)
    with pytest.raises(ProgramError, match="expected of 'bench_raw send=.*' the answer 'sent'"):
        rounds.run(rounds.steps(["ends"], (8, 0, 1)), 1, results, print)


@pytest.mark.slow
def test_nodelets_are_loaded_by_one_manager(master, tmp_path):
    with Running(WAYS["cpp_nodelet"], tmp_path / "log") as running:
        running.start()
        running.connect()
        running.signal(signal.SIGCONT)
        services = subprocess.check_output(["rosservice", "list"], text=True).split()
        (manager,) = {name[: -len("/list")] for name in services if name.endswith("/list")}
        listed = subprocess.check_output(["rosservice", "call", manager + "/list"], text=True)
        nodes = subprocess.check_output(["rosnode", "list"], text=True).split()
    assert yaml.safe_load(listed) == {"nodelets": [manager + "_Receiver", manager + "_Sender"]}
    assert nodes == [manager, "/rosout"]


@pytest.mark.slow
def test_robots_start_and_stop(master, tmp_path):
    results = rounds.Results(tmp_path)
    launches.run([2], 1, results, print)
    (found,) = launches.load(results)
    names = {
        f"robot{number}/{kind}_{language}_node"
        for number in (1, 2)
        for kind in ("publisher", "subscriber")
        for language in ("cpp", "py")
    }
    assert found["ready"].keys() == names
    assert found["up"] < found["stop"] < found["end"]
    assert 0 < found["cpp_megabytes"] < found["py_megabytes"]
    assert found["cores"] > 0
    assert len(found["pair"]["sent"]) == launches.STREAM.count
    assert found["pair"]["received"][::2] == found["pair"]["sent"]


CONSOLE = """\
\x1b[1mprocess[mrp/publisher_cpp_node-2]: started with pid [12]\x1b[0m
[ INFO] [1795222168.680630550]: [PUBLISHER CPP NODE] namespace of nh = /mrp/publisher_cpp_node
[ INFO] [1795222169.082939615]: [SUBSCRIBER CPP NODE] namespace of nh = /mrp/subscriber_cpp_node
[ INFO] [1795222169.182939615]: [SUBSCRIBER CPP NODE] received message with data = 2
"""


def test_nodes_are_up_when_all_are_ready_and_each_subscriber_has_a_message():
    console = Console()
    *ready, received = CONSOLE.splitlines(keepends=True)
    for moment, line in enumerate(ready):
        console.add(moment, line)
    assert not console.is_up(2), "no message yet"
    console.add(len(ready), received)
    assert console.is_up(2)
    assert not console.is_up(4), "two nodes"
    assert console.ready == {"mrp/publisher_cpp_node": 1, "mrp/subscriber_cpp_node": 2}


@pytest.fixture
def mark(monkeypatch):
    """An environment variable that no process has but those that are started from now on.

    What is left of them at the end is killed.
    """
    variable = f"MRP_TEST_MARK={uuid.uuid4()}"
    monkeypatch.setenv(*variable.split("="))
    yield variable
    for pid in processes_with(variable):
        os.kill(pid, signal.SIGKILL)


@pytest.mark.slow
def test_ros_spin_takes_a_core_while_its_node_ends(master):
    """mrp_bench's own spin() doesn't. A master that stands still keeps both from ending."""
    core = rosgraph.Master("/test_bench")
    with Process("rosrun", "mrp", "subscriber_cpp_node") as plain:
        with Process("rosrun", "mrp_bench", "bench_node", "subscribe=1") as calm:
            wait_until(
                lambda: (
                    {"/great_topic", "/small"} <= {name for name, _ in core.getSystemState()[1]}
                ),
                "both have subscribed",
            )
            pid = core.getPid()
            os.kill(pid, signal.SIGSTOP)
            try:
                begin = cpu([plain.pid]), cpu([calm.pid])
                for node in (plain, calm):
                    os.kill(node.pid, signal.SIGINT)
                wait_until(lambda: cpu([plain.pid]) - begin[0] > 1, "a second of processor time")
                assert cpu([calm.pid]) - begin[1] < 0.1
            finally:
                os.kill(pid, signal.SIGCONT)
            assert [plain.wait(), calm.wait()] == [0, 0]


BENCH_THAT_WAITS = """
import pathlib, signal, sys
from mrp_bench.processes import Master
from mrp_bench.programs import Running
from mrp_bench.ways import WAYS

log = pathlib.Path(sys.argv[1])
with Master(log), Running(WAYS["py_cpp"], log) as running:
    running.start()
    running.connect()
    print("connected", flush=True)
    signal.pause()
"""


@pytest.mark.slow
def test_nothing_outlives_a_bench_that_is_killed(mark, tmp_path):
    """A master with a child of its own, and programs that stand still."""
    with Process(sys.executable, "-c", BENCH_THAT_WAITS, str(tmp_path / "log")) as bench:
        bench.wait_for(lambda: "connected" in bench.lines, "the programs are connected")
        commands = processes_with(mark).values()
        for name in ("rosmaster", "bench_node", "bench_node.py"):
            assert any(name in command for command in commands), (name, commands)
        os.kill(bench.pid, signal.SIGKILL)
        wait_until(lambda: not processes_with(mark), "all have ended")


def test_rospy_sleeps_after_each_message_that_it_queues(monkeypatch):
    """Counts the sleeps: time.sleep(0) after each message that waits in the queue."""

    class Connection:
        done = False
        written = []

        def set_cleanup_callback(self, callback):
            self.wake_up = callback

        def write_data(self, data):
            self.written.append(data)

    connection = Connection()
    before = threading.enumerate()
    queued = tcpros_pubsub.QueuedConnection(connection, 0)
    (sending,) = {*threading.enumerate()} - {*before}
    sleeps = []
    monkeypatch.setattr(tcpros_pubsub.time, "sleep", sleeps.append)
    try:
        for number in range(3):
            queued.write_data(number)
        assert sleeps == [0, 0, 0]
    finally:
        monkeypatch.undo()
        wait_until(lambda: connection.written == [0, 1, 2], "the sending thread has sent all")
        connection.done = True
        connection.wake_up(connection)
        sending.join()
