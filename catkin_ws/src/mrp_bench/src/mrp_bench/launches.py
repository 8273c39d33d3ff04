# SPDX-License-Identifier: BSD-3-Clause
"""Starts and stops of the tutorial's four nodes for many robots: what each costs."""

import json
import pathlib

from mrp_bench.launched import Launched
from mrp_bench.processes import cpu, megabytes
from mrp_bench.programs import Running, Stream
from mrp_bench.ways import WAYS

# Beside the robots, whose own messages have no stamp: a node that sends for two seconds, and one
# that receives. So long the robots' processor time is taken, too.
PAIR, STREAM = WAYS["cpp_cpp"], Stream(size=8, rate=100, count=200)


def _launch_file(robots):
    """Return the text of a launch file that starts the tutorial's nodes in that many groups."""
    groups = [
        '<include file="$(find mrp)/launch/pub_sub.launch">'
        f'<arg name="group" value="robot{number}"/></include>'
        for number in range(1, robots + 1)
    ]
    return f"<launch>{''.join(groups)}</launch>"


def measure(robots, results):
    """Start that many robots with roslaunch, and stop them with SIGINT; return what happened.

    Times are in seconds since the start of roslaunch. pair: what became of STREAM.
    Raises ProgramError if a node does not come up, or roslaunch does not end.
    """
    file = results.folder / "launches" / f"{robots}_robots.launch"
    file.write_text(_launch_file(robots))
    with Launched(["roslaunch", str(file)]) as launched:
        launched.wait_until_up(4 * robots)
        pids = launched.pids()
        memory = {"cpp": [], "py": []}
        for pid in pids:
            memory["py" if _is_python(pid) else "cpp"].append(megabytes(pid))
        with Running(PAIR, results.folder / "programs.log") as pair:
            pair.start()
            pair.connect()
            before, moment = cpu(pids), launched.now()
            measurement = pair.measure(STREAM)
            cores = (cpu(pids) - before) / (launched.now() - moment)
        stop, _, end = launched.stop({})
    found = launched.console.events
    return {
        "robots": robots,
        "events": found,
        "up": max(moment for moment, what, _ in found if what == "ready"),
        "stop": stop,
        "end": end,
        "cores": cores,
        "cpp_megabytes": sum(memory["cpp"]) / len(memory["cpp"]),
        "py_megabytes": sum(memory["py"]) / len(memory["py"]),
        "pair": {"sent": measurement.sent, "received": measurement.received[0]},
    }


def _is_python(pid):
    return "python" in pathlib.Path(f"/proc/{pid}/exe").resolve().name


def run(robots, rounds, results, say):
    """Measure each number of robots that often; keep what is found in the results' folder."""
    folder = results.folder / "launches"
    folder.mkdir(exist_ok=True)
    for number in range(rounds):
        for count in robots:
            path = folder / f"{count}_robots_{number}.json"
            line = f"start and stop of {count} robots, round {number + 1} of {rounds}"
            results.once(path, lambda: measure(count, results), say, line)


def load(results):
    """Return all that run() has kept, sorted by the number of robots."""
    paths = (results.folder / "launches").glob("*.json")
    return sorted((json.loads(path.read_text()) for path in paths), key=lambda one: one["robots"])
