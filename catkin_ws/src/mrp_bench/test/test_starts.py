# SPDX-License-Identifier: BSD-3-Clause
"""make bench: the start and stop of the four nodes."""

import json

import pytest
from mrp_bench import rounds, start_figures, starts, tables
from mrp_bench.launched import Console, exits

pytestmark = pytest.mark.quick

ROSLAUNCH_SAYS = """\
... logging to /tmp/some.log
\x1b[1mprocess[master]: started with pid [10]\x1b[0m
\x1b[1msetting /run_id to 7dab871e\x1b[0m
process[rosout-1]: started with pid [11]
\x1b[1mprocess[mrp/publisher_cpp_node-2]: started with pid [12]\x1b[0m
[ INFO] [1795222168.680630550]: [PUBLISHER CPP NODE] namespace of nh = /mrp/publisher_cpp_node
[ INFO] [1795222169.082939615]: [SUBSCRIBER CPP NODE] namespace of nh = /mrp/subscriber_cpp_node
[ INFO] [1795222169.182939615]: [SUBSCRIBER CPP NODE] received message with data = 2
[ INFO] [1795222169.682939615]: [SUBSCRIBER CPP NODE] received message with data = 4
[mrp/publisher_cpp_node-2] killing on exit[mrp/subscriber_cpp_node-4] killing on exit
[master] killing on exit
shutting down processing monitor...
"""


def console(lines):
    found = Console()
    for moment, line in enumerate(lines):
        found.add(moment, line)
    return found


def test_events_of_a_launch():
    found = console(ROSLAUNCH_SAYS.splitlines(keepends=True))
    assert found.events == [
        (0, "first line", ""),
        (1, "started", "master"),
        (2, "master", ""),
        (3, "started", "rosout"),
        (4, "started", "mrp/publisher_cpp_node"),
        (5, "ready", "mrp/publisher_cpp_node"),
        (6, "ready", "mrp/subscriber_cpp_node"),
        (7, "received", "SUBSCRIBER CPP NODE"),
        (9, "stopping", "mrp/publisher_cpp_node"),
        (9, "stopping", "mrp/subscriber_cpp_node"),
        (10, "stopping", "master"),
    ]
    assert found.pids == {"master": 10, "rosout": 11, "mrp/publisher_cpp_node": 12}


def test_nodes_are_up_when_all_are_ready_and_each_subscriber_has_a_message():
    lines = ROSLAUNCH_SAYS.splitlines(keepends=True)
    assert console(lines).is_up(2)
    assert not console(lines[:7]).is_up(2), "no message yet"
    assert not console(lines).is_up(4), "two nodes"


def test_exit_codes_are_in_the_log_of_roslaunch():
    log = """\
[roslaunch][INFO] 2026-11-21 23:23:06,131: process[mrp/a-4]: SIGINT killed with return value -6
[roslaunch][INFO] 2026-11-21 23:23:06,132: process[mrp/b-5]: SIGTERM killed with return value 0
[roslaunch][INFO] 2026-11-21 23:23:08,545: process[master]: SIGINT killed with return value 1
"""
    assert exits(log) == {"mrp/a": -6, "mrp/b": 0, "master": 1}


def one_start(later=0.0, **other):
    nodes = ("publisher_cpp_node", "publisher_py_node", "subscriber_cpp_node", "subscriber_py_node")
    events = [(0.5, "first line", ""), (0.6, "started", "master"), (1, "master", "")]
    events += [(1.1, "started", "rosout")]
    events += [(1.5 + 0.1 * i, "started", f"mrp/{node}") for i, node in enumerate(nodes)]
    events += [(2 + 0.1 * i, "ready", f"mrp/{node}") for i, node in enumerate(nodes)]
    events += [
        (3 + later, "received", "SUBSCRIBER CPP NODE"),
        (4, "received", "SUBSCRIBER PY NODE"),
    ]
    return {
        "events": events,
        "stop": 5,
        "ended": {"mrp/publisher_cpp_node": 6, "mrp/subscriber_py_node": 7, "rosout": 7.5},
        "end": 8,
        "exits": {"mrp/publisher_cpp_node": 0, "rosout": 0},
        **other,
    }


def content_of(starts, verdict=None):
    """Return the part of results.json that says when nodes started, as the pages read it."""
    content = {
        "verdict": verdict,
        "rows": [],
        "starts": start_figures.summarise(starts),
        "robots": {"figures": [], "exponents": {}},
    }
    return json.loads(json.dumps(content))


def test_table_of_starts():
    exits_seen = {"mrp/publisher_cpp_node": -6, "mrp/b": 1, "rosout": 0}
    measured = [one_start(later=0), one_start(later=1), one_start(later=2, exits=exits_seen)]
    (table,) = tables.starts(content_of(measured))
    assert [" | ".join(row) for row in (table.header, *table.rows)] == [
        "until | seconds",
        "roslaunch's first line | 0.50 [0.50, 0.50]",
        "the master answers | 1.00 [1.00, 1.00]",
        "the first node is started | 1.50 [1.50, 1.50]",
        "all four are started | 1.80 [1.80, 1.80]",
        "all four are ready | 2.30 [2.30, 2.30]",
        "first message at the C++ subscriber | 4.00 [3.00, 5.00]",
        "first message at the Python subscriber | 4.00 [4.00, 4.00]",
        "Ctrl-C to the end of all four | 2.00 [2.00, 2.00]",
        "Ctrl-C to the prompt | 3.00 [3.00, 3.00]",
        "exit codes | publisher_cpp_node: SIGABRT (1 of 3), b: 1 (1 of 3)",
    ]
    (noisy,) = tables.starts(content_of(measured, verdict="noisy"))
    assert noisy.rows[4] == ["all four are ready", "too noisy"]
    assert tables.starts(content_of([])) == []


@pytest.mark.slow
def test_tutorial_starts_and_stops(tmp_path):
    results = rounds.Results(tmp_path)
    starts.run(1, results, print)
    (found,) = starts.load(results)
    names = {name for _, what, name in found["events"] if what == "ready"}
    assert len(names) == 4
    assert set(found["ended"]) == set(found["exits"]) == names | {"master", "rosout"}
    assert set(found["exits"].values()) == {0}
    received = {name for _, what, name in found["events"] if what == "received"}
    assert received == {"SUBSCRIBER CPP NODE", "SUBSCRIBER PY NODE"}
    ended = found["ended"].values()
    assert found["stop"] < min(ended) <= max(ended) < found["end"]

    starts.run(1, results, pytest.fail)
