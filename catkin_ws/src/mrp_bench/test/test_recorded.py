# SPDX-License-Identifier: BSD-3-Clause
"""The page on speed says what the recorded figures say, recorded/results.json."""

import json

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

NODES = ("cpp_cpp", "cpp_py", "py_cpp", "py_py")


@pytest.fixture(scope="module")
def results():
    return json.loads((WORKSPACE / "src/mrp/doc/recorded/results.json").read_text())


@pytest.fixture(scope="module")
def rows(results):
    """(way, size, rate) -> what was measured. A rate of 0 is as fast as it goes."""
    return {(row["way"], row["size"], row["rate"]): row for row in results["rows"]}


def test_small_messages(rows):
    small = {way: rows[way, 8, 1000] for way in NODES}
    assert max(row["latency"]["p99"] for row in small.values()) < 300
    # To one decimal, as the table has it.
    ratios = [round(row["latency_ratio"]["raw_cpp"][0], 1) for row in small.values()]
    assert 2 <= min(ratios) and max(ratios) <= 5
    assert small["cpp_py"]["latency"]["p50"] < small["cpp_cpp"]["latency"]["p50"]


def test_messages_per_second(rows):
    fast = {
        way: row["throughput"] for (way, size, rate), row in rows.items() if (size, rate) == (8, 0)
    }
    assert min(fast["cpp_cpp"], fast["cpp_py"]) > 10 * max(fast["py_cpp"], fast["py_py"])
    assert fast["py_timer_slack"] > 2 * fast["py_py"]
    assert fast["py_unqueued"] > 10 * fast["py_py"]
    assert fast["cpp_batch"] > 20 * fast["cpp_cpp"]


def test_tcp_no_delay(rows):
    for plain, hinted in (("cpp_cpp", "cpp_no_delay"), ("py_py", "py_no_delay")):
        p50 = [rows[way, 8, 1000]["latency"]["p50"] for way in (plain, hinted)]
        assert p50[1] / p50[0] == pytest.approx(1, abs=0.1)
    assert rows["cpp_cpp", 1024, 1000]["latency"]["p99"] > 10_000
    assert rows["cpp_no_delay", 1024, 1000]["latency"]["max"] < 10_000


def test_four_subscribers(rows):
    for one, four in (("cpp_cpp", "cpp_to_4"), ("py_py", "py_to_4")):
        assert rows[four, 8, 1000]["sender_cpu"] < 4 * rows[one, 8, 1000]["sender_cpu"]


def test_memory_of_a_node(results):
    (fifty,) = (figure for figure in results["robots"]["figures"] if figure["robots"] == 50)
    assert fifty["py"] > 20 * fifty["cpp"]
