# SPDX-License-Identifier: BSD-3-Clause
"""Starts and stops of the tutorial's four nodes, for one robot and for many."""

import json
import os
import pathlib
import re
import signal
import subprocess
import threading
import time

from mrp_bench.processes import megabytes, tree
from mrp_bench.programs import ProgramError

# Seconds in which all nodes must be up: on two cores, those of 50 robots take less than a minute.
_DEADLINE = 300

# Seconds over which the nodes' processor time is taken while they do their work.
_WINDOW = 2

_ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_STARTED = re.compile(r"process\[(\S+)-\d+\]: started with pid \[(\d+)\]")
_READY = re.compile(r"\] namespace of \w+ = /(\S+)")
_RECEIVED = re.compile(r"\[(SUBSCRIBER \w+ NODE)\] received message with data = \d+")
_KILLED = re.compile(r"\[(\S+)-\d+\] killing on exit")


def events(lines):
    """Return what the lines of roslaunch and of the nodes say has happened.

    lines: pairs of a time, and a line
    Returns a list of triples: the time; "started", "ready", "received" (the first message) or
    "stopping"; and the node's name without its first slash, or which subscriber it is.
    """
    found = {}
    for moment, line in lines:
        line = _ESCAPES.sub("", line)
        for what, pattern in (
            ("started", _STARTED),
            ("ready", _READY),
            ("received", _RECEIVED),
            ("stopping", _KILLED),
        ):
            # Of several in one line: roslaunch's threads print at once.
            for match in pattern.finditer(line):
                found.setdefault((what, match.group(1)), moment)
    return [(moment, *one) for one, moment in found.items()]


def _launch_file(robots):
    """Return the text of a launch file that starts the tutorial's nodes in that many groups."""
    groups = [
        '<include file="$(find mrp)/launch/pub_sub.launch">'
        f'<arg name="group" value="robot{number}"/></include>'
        for number in range(1, robots + 1)
    ]
    return f"<launch>{''.join(groups)}</launch>"


def measure(robots, folder):
    """Start that many robots with roslaunch, and stop them with SIGINT; return what happened.

    Times are in seconds since the start of roslaunch. Raises ProgramError if a node does not come
    up, or roslaunch does not end.
    """
    file = folder / f"{robots}_robots.launch"
    file.write_text(_launch_file(robots))
    lines = []
    begin = time.monotonic()
    process = subprocess.Popen(
        ["roslaunch", str(file)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    reader = threading.Thread(target=_read, args=(process.stdout, lines, begin))
    reader.start()
    try:
        _wait_until_up(process, lines, robots)
        pids = [pid for pid in tree(process.pid) if pid != process.pid]
        memory = {"cpp": [], "py": []}
        for pid in pids:
            memory["py" if _is_python(pid) else "cpp"].append(megabytes(pid))
        cpu, moment = _cpu(pids), time.monotonic()
        time.sleep(_WINDOW)
        cores = (_cpu(pids) - cpu) / (time.monotonic() - moment)
        stop = time.monotonic() - begin
        process.send_signal(signal.SIGINT)
        process.wait(_DEADLINE)
        end = time.monotonic() - begin
    except subprocess.TimeoutExpired as error:
        raise ProgramError(f"expected roslaunch to end within {_DEADLINE} s of SIGINT") from error
    finally:
        if process.poll() is None:
            for pid in reversed(tree(process.pid)):
                os.kill(pid, signal.SIGKILL)
            process.wait()
        reader.join()
    return {
        "robots": robots,
        "events": events(lines),
        "up": max(moment for moment, what, _ in events(lines) if what == "ready"),
        "stop": stop,
        "end": end,
        "cores": cores,
        "cpp_megabytes": sum(memory["cpp"]) / len(memory["cpp"]),
        "py_megabytes": sum(memory["py"]) / len(memory["py"]),
    }


def _read(stream, lines, begin):
    with stream:
        for line in stream:
            lines.append((time.monotonic() - begin, line))


def _wait_until_up(process, lines, robots):
    """Wait until each node has said its namespace, and a message has come to both subscribers."""
    end = time.monotonic() + _DEADLINE
    while True:
        whats = [what for _, what, _ in events(list(lines))]
        if whats.count("ready") == 4 * robots and whats.count("received") == 2:
            return
        if process.poll() is not None or time.monotonic() > end:
            text = "".join(line for _, line in lines)
            raise ProgramError(f"expected {4 * robots} nodes that run, found:\n{text}")
        time.sleep(0.05)


def _is_python(pid):
    return "python" in pathlib.Path(f"/proc/{pid}/exe").resolve().name


def _cpu(pids):
    return sum(
        int(path.read_text().split()[0]) / 1e9
        for pid in pids
        for path in pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat")
    )


def run(robots, rounds, results, say):
    """Measure each number of robots that often; keep what is found in the results' folder."""
    folder = results.folder / "launches"
    folder.mkdir(exist_ok=True)
    for number in range(rounds):
        for count in robots:
            path = folder / f"{count}_robots_{number}.json"
            if path.exists():
                continue
            say(f"start and stop of {count} robots, round {number + 1} of {rounds}")
            found = json.dumps(measure(count, folder), indent=1)
            unfinished = path.with_suffix(".unfinished")
            unfinished.write_text(found)
            unfinished.rename(path)


def load(results):
    """Return all that run() has kept, sorted by the number of robots."""
    paths = (results.folder / "launches").glob("*.json")
    return sorted((json.loads(path.read_text()) for path in paths), key=lambda one: one["robots"])
