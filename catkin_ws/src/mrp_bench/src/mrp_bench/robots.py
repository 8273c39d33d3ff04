# SPDX-License-Identifier: BSD-3-Clause
"""Starts and stops the four nodes for many robots: what each costs."""

import signal
import statistics
import subprocess
import time

import psutil
import rosgraph

from mrp_bench.running import ProgramError

# Seconds in which all nodes must be up, or have ended: on two cores, those of 50 robots take less
# than a minute.
_DEADLINE = 300
_WHILE = 3  # seconds for which the processor time is taken

HEAD = [
    *("robots", "all nodes ready, s", "Ctrl-C to the end, s", "cores in use"),
    *("MB per C++ node", "MB per Python node"),
]


def measure(count, log, say):
    """Start that many robots with roslaunch, and stop them with SIGINT; return a row of a table.

    log: a file for what the programs print; say: is called with a line
    Raises ProgramError if a node does not come up, or roslaunch does not end.
    """
    say(f"start and stop of {count} robots")
    groups = (
        '<include file="$(find mrp)/launch/pub_sub.launch">'
        f'<arg name="group" value="robot{number}"/></include>'
        for number in range(1, count + 1)
    )
    begin = time.monotonic()
    with log.open("ab") as file:
        roslaunch = psutil.Popen(
            ["roslaunch", "-"],
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
        nodes = [node for node in roslaunch.children() if "__name:=rosout" not in node.cmdline()]
        memory = {True: [], False: []}
        for node in nodes:
            memory["python" in node.exe()].append(node.memory_full_info().pss / 2**20)
        cpu = -_cpu(nodes)
        time.sleep(_WHILE)
        cores = (cpu + _cpu(nodes)) / _WHILE
        stop = time.monotonic()
        roslaunch.send_signal(signal.SIGINT)
        roslaunch.wait(_DEADLINE)
    except psutil.TimeoutExpired:
        raise ProgramError(f"expected roslaunch to end within {_DEADLINE} s of SIGINT") from None
    finally:
        if roslaunch.poll() is None:
            for process in [*roslaunch.children(recursive=True), roslaunch]:
                process.kill()
            roslaunch.wait()
    down = time.monotonic() - stop
    means = (statistics.mean(memory[is_python]) for is_python in (False, True))
    return [str(count), *(f"{value:.2f}" for value in (up, down, cores, *means))]


def _nodes():
    """Return the robots' nodes that the master knows, each once it has its topic."""
    publishers, subscribers, _ = rosgraph.Master("/bench").getSystemState()
    return {
        name
        for topic, names in publishers + subscribers
        if topic.startswith("/robot")
        for name in names
    }


def _cpu(nodes):
    return sum(sum(node.cpu_times()[:2]) for node in nodes)
