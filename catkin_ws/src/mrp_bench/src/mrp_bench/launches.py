# SPDX-License-Identifier: BSD-3-Clause
"""Starts and stops of the four nodes for many robots: what each costs."""

import collections
import json
import pathlib
import statistics

from mrp_bench import stats
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
        stop, end = launched.stop()
    return {
        "robots": robots,
        "ready": launched.console.ready,
        "up": max(launched.console.ready.values()),
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
            say(f"start and stop of {count} robots, round {number + 1} of {rounds}")
            found = json.dumps(measure(count, results), indent=1)
            (folder / f"{count}_robots_{number}.json").write_text(found)


def load(results):
    """Return all that run() has kept, sorted by the number of robots."""
    paths = (results.folder / "launches").glob("*.json")
    return sorted(
        (json.loads(path.read_text()) for path in paths), key=lambda launch: launch["robots"]
    )


# What is tabled: a name, and how it follows from what was measured.
_FIGURES = {
    "up": lambda launch: launch["up"],
    "down": lambda launch: launch["end"] - launch["stop"],
    "cores": lambda launch: launch["cores"],
    "cpp": lambda launch: launch["cpp_megabytes"],
    "py": lambda launch: launch["py_megabytes"],
    "p50": lambda launch: _latency(launch, "p50"),
    "p99": lambda launch: _latency(launch, "p99"),
}


def _delivery(launch):
    return stats.delivery(launch["pair"]["sent"], launch["pair"]["received"])


def _latency(launch, percentile):
    return stats.percentiles(_delivery(launch).latencies)[percentile] / 1e3


def medians(launches):
    """Return the number of robots -> a figure's name -> its median over the rounds."""
    grouped = collections.defaultdict(list)
    for launch in launches:
        grouped[launch["robots"]].append(launch)
    return {
        robots: {name: statistics.median(map(value, of)) for name, value in _FIGURES.items()}
        for robots, of in sorted(grouped.items())
    }


def summarise(launches):
    """Return what results.json says of many robots."""
    figures = medians(launches)
    lost = collections.Counter()
    for launch in launches:
        lost[launch["robots"]] += _delivery(launch).lost
    return {
        "figures": [
            {"robots": robots, **of, "lost": lost[robots]} for robots, of in figures.items()
        ],
    }
