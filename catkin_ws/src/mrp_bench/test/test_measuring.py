# SPDX-License-Identifier: BSD-3-Clause
"""make bench: does every message arrive, whatever carries it, and is nothing left running?"""

import os
import signal
import threading

import psutil
import pytest
import rosgraph
from mrp_bench import figures, robots, running
from mrp_bench.ways import LIMIT, PLAN, WAYS, Stream, Way, steps
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import Process
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


@pytest.fixture(scope="module")
def core():
    """A master for these tests."""
    port = free_port()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_MASTER_URI", uri_of(port))
        with master(port) as process:
            yield process


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
def test_every_way_delivers_every_message_in_order(core, tmp_path, way):
    """What is lost, or comes too late, is an error."""
    # A small and a large message, if the way is measured with it.
    sizes = {8 if stream.size == 8 else 70000 for name, stream in PLAN if name == way}
    for stream in (Stream(size, 500, 100) for size in sizes):
        found = running.measure(way, stream, tmp_path / "log")
        assert len(found.latencies) == 90 * WAYS[way].subscribers
        assert min(found.latencies) > 0 and found.throughput > 0 and found.sender_cpu > 0
        assert WAYS[way].subscriber is None or found.receiver_cpu > 0


@pytest.mark.parametrize("received", [[1, 3], [1, 3, 2], [1, 2, 2]])
def test_message_that_is_lost_or_late_is_an_error(monkeypatch, tmp_path, received):
    class Program(running.Program):
        def result(self):
            cpu, pairs = super().result()
            return cpu, pairs[[stamp - 1 for stamp in received]] if pairs.size else pairs

    monkeypatch.setattr(running, "Program", Program)
    with pytest.raises(running.ProgramError, match="expected 3 messages in order in raw"):
        running.measure(LIMIT, Stream(8, 100, 3), tmp_path / "log")


@pytest.mark.slow
def test_ways_are_measured_in_turns(core, tmp_path):
    lines = []
    plan = steps(TWO, 8, 200, 10)
    found = figures.measure_all(3, tmp_path / "log", lines.append, plan)
    assert [line.split(": ")[1].split(",")[0] for line in lines] == [*TWO] * 3
    assert all(line.endswith(" s left") for line in lines)
    assert lines[-1].startswith("[6/6] round 3 of 3: py_py, 8 B at 200 Hz")
    assert {key: len(rounds) for key, rounds in found.items()} == {
        (name, 8, 200): 3 for name in TWO
    }


@pytest.mark.slow
def test_program_that_fails_is_an_error(monkeypatch, tmp_path):
    # It knows none of the parameters.
    monkeypatch.setitem(WAYS, "fails", Way("fails", "bench.py", "bench.py"))
    with pytest.raises(running.ProgramError, match="expected exit code 0, found 2 of bench.py"):
        running.measure("fails", Stream(8, 0, 1), tmp_path / "log")


def test_master_is_that_of_what_is_started(monkeypatch, tmp_path):
    monkeypatch.setenv("ROS_MASTER_URI", "")
    with running.master(tmp_path / "log"):
        assert rosgraph.is_master_online()
    assert not rosgraph.is_master_online()


@pytest.mark.slow
def test_robots_start_and_stop(core, tmp_path):
    table = [robots.HEAD, robots.measure(2, tmp_path / "log", print)]
    row = dict(zip(*table))
    assert row.pop("robots") == "2"
    assert float(row.pop("cores in use")) >= 0
    assert all(float(cell) > 0 for cell in row.values())
    assert float(row["MB per C++ node"]) < float(row["MB per Python node"])


@pytest.mark.slow
def test_ros_spin_takes_a_core_while_its_node_ends(core):
    """mrp_bench's own spin() doesn't. A master that stands still keeps both from ending."""
    state = rosgraph.Master("/test_bench").getSystemState
    with Process("rosrun", "mrp", "subscriber_cpp_node") as plain:
        with Process("rosrun", "mrp_bench", "bench_node", "_subscribe:=true") as calm:
            wait_until(
                lambda: {"/great_topic", "/messages"} <= {name for name, _ in state()[1]},
                "both have subscribed",
            )
            os.kill(core.pid, signal.SIGSTOP)
            try:
                begin = cpu(plain), cpu(calm)
                for node in (plain, calm):
                    os.kill(node.pid, signal.SIGINT)
                wait_until(lambda: cpu(plain) - begin[0] > 1, "a second of processor time")
                assert cpu(calm) - begin[1] < 0.1
            finally:
                os.kill(core.pid, signal.SIGCONT)
            assert [plain.wait(), calm.wait()] == [0, 0]


def cpu(process):
    """Return the processor time that a process has used, in seconds."""
    return sum(psutil.Process(process.pid).cpu_times()[:2])


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
