# SPDX-License-Identifier: BSD-3-Clause
"""Starts and stops the four nodes for many robots: what each costs."""

import os
import pathlib
import signal
import subprocess
import time

import rosgraph

from mrp_bench.figures import delivery, percentiles
from mrp_bench.programs import ProgramError, Running, cpu, megabytes, tree, with_parent
from mrp_bench.ways import WAYS, Stream

# Seconds in which all nodes must be up, or have ended: on two cores, those of 50 robots take less
# than a minute.
_DEADLINE = 300

# Beside the robots, whose own messages have no stamp: a node that sends for two seconds, and one
# that receives. So long the robots' processor time is taken, too.
_PAIR, _STREAM = WAYS["cpp_cpp"], Stream(size=8, rate=100, count=200)


def measure(count, log, say):
    """Start that many robots with roslaunch, and stop them with SIGINT; return their figures.

    log: a file for what the programs print; say: is called with a line
    Raises ProgramError if a node does not come up, or roslaunch does not end.
    """
    say(f"start and stop of {count} robots")
    groups = (
        '<include file="$(find mrp)/launch/pub_sub.launch">'
        f'<arg name="group" value="robot{number}"/></include>'
        for number in range(1, count + 1)
    )
    with log.open("ab") as file:
        begin = time.monotonic()
        roslaunch = subprocess.Popen(
            with_parent(["roslaunch", "-"], signal.SIGINT),
            stdin=subprocess.PIPE,
            stdout=file,
            stderr=file,
            start_new_session=True,
        )
    try:
        roslaunch.stdin.write(f"<launch>{''.join(groups)}</launch>".encode())
        roslaunch.stdin.close()
        while len(_nodes()) < 4 * count:
            if roslaunch.poll() is not None or time.monotonic() - begin > _DEADLINE:
                raise ProgramError(f"expected {4 * count} nodes, found {_nodes()}: see {log}")
            time.sleep(0.05)
        up = time.monotonic() - begin
        pids = [pid for pid in tree(roslaunch.pid) if pid != roslaunch.pid]
        memory = {"cpp": [], "py": []}
        for pid in pids:
            memory["py" if _is_python(pid) else "cpp"].append(megabytes(pid))
        with Running(_PAIR, log) as pair:
            before, moment = cpu(pids), time.monotonic()
            found = pair.measure(_STREAM)
            cores = (cpu(pids) - before) / (time.monotonic() - moment)
        stop = time.monotonic()
        roslaunch.send_signal(signal.SIGINT)
        roslaunch.wait(_DEADLINE)
    except subprocess.TimeoutExpired:
        raise ProgramError(f"expected roslaunch to end within {_DEADLINE} s of SIGINT") from None
    finally:
        if roslaunch.poll() is None:
            for pid in reversed(tree(roslaunch.pid)):
                os.kill(pid, signal.SIGKILL)
            roslaunch.wait()
    arrived = delivery(found.sent, found.received[0])
    latency = percentiles(arrived.latencies / 1e3)
    return {
        "robots": count,
        "up": up,
        "down": time.monotonic() - stop,
        "cores": cores,
        **{language: sum(of) / len(of) for language, of in memory.items()},
        "p50": latency["p50"],
        "p99": latency["p99"],
        "lost": arrived.lost,
    }


def _nodes():
    """Return the robots' nodes that the master knows, each once it has its topic."""
    publishers, subscribers, _ = rosgraph.Master("/bench").getSystemState()
    return {
        name
        for topic, names in publishers + subscribers
        if topic.startswith("/robot")
        for name in names
    }


def _is_python(pid):
    return "python" in pathlib.Path(f"/proc/{pid}/exe").resolve().name
