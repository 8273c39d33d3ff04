# SPDX-License-Identifier: BSD-3-Clause
"""make bench: does every message arrive, whatever carries it, and is nothing left running?"""

import os
import signal
import sys
import threading
import uuid

import pytest
import rosgraph
from mrp_bench import figures, robots
from mrp_bench.programs import Master, ProgramError, Running, cpu
from mrp_bench.ways import LIMIT, PLAN, WAYS, Stream, Way, steps
from mrp_testing.process import Process, processes_with
from mrp_testing.waiting import wait_until
from rospy.impl import tcpros_pubsub

pytestmark = pytest.mark.quick

TWO = (LIMIT, "py_py")


def test_every_way_is_measured_beside_the_limit():
    assert {way for way, _ in PLAN} == set(WAYS)
    for _, stream in PLAN:
        assert {way for way, other in PLAN if other[:2] == stream[:2]} >= {LIMIT}
    assert len({(way, *stream[:2]) for way, stream in PLAN}) == len(PLAN), (
        "something is twice there"
    )


@pytest.fixture
def master(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", os.environ.get("ROS_MASTER_URI", ""))
    with Master(tmp_path / "master.log"):
        yield


@pytest.mark.slow
def test_every_way_delivers_every_message_in_order(master, tmp_path):
    for way in WAYS.values():
        with Running(way, tmp_path / "log") as running:
            for stream in (Stream(8, 200, 10), Stream(70000, 0, 3)):
                found = running.measure(stream)
                assert len(found.received) == way.receivers
                for pairs in found.received:
                    assert pairs[::2] == found.sent, way.name
                    assert all(arrival > stamp for stamp, arrival in zip(pairs[::2], pairs[1::2]))
                assert found.sender_cpu > 0
                assert way.receiver is None or found.receiver_cpu > 0


@pytest.mark.slow
def test_ways_are_measured_in_turns(master, tmp_path):
    lines = []
    plan = steps(TWO, (8, 200, 10), (70000, 0, 3))
    rows = figures.measure(4, tmp_path / "log", lines.append, plan)
    assert [line.split(" of 4")[0][-1] for line in lines] == [*"1111222233334444"]
    assert [line.split(": ")[1].split(",")[0] for line in lines] == [
        name for name in TWO for _ in range(2)
    ] * 4
    assert all(line.endswith(" s left") for line in lines)
    assert lines[-1].startswith("[16/16] round 4 of 4: py_py, 68 kB as fast as it goes")
    assert [(row["way"], row["size"], row["rounds"]) for row in rows] == [
        (name, size, 4) for size in (8, 70000) for name in TWO
    ]


@pytest.mark.slow
def test_program_that_ends_is_an_error(tmp_path):
    ends = Way("ends", "ends", ("bench_raw", "send=1"), ("bench_raw", "receive=1"))
    with pytest.raises(ProgramError, match="expected of 'bench_raw send=.*' the answer 'ready'"):
        with Running(ends, tmp_path / "log"):
            pass


@pytest.mark.slow
def test_robots_start_and_stop(master, tmp_path):
    found = robots.measure(2, tmp_path / "log", print)
    assert found["up"] > 0 and found["down"] > 0 and found["cores"] > 0
    assert 0 < found["cpp"] < found["py"]
    assert 0 < found["p50"] <= found["p99"]
    assert found["lost"] == 0


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
from mrp_bench.programs import Master, Running
from mrp_bench.ways import WAYS

log = pathlib.Path(sys.argv[1])
with Master(log), Running(WAYS["py_cpp"], log) as running:
    print("connected", flush=True)
    signal.pause()
"""


@pytest.mark.slow
def test_nothing_outlives_a_bench_that_is_killed(mark, tmp_path):
    """A master with a child of its own, and programs that wait for orders."""
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
