# SPDX-License-Identifier: BSD-3-Clause
"""make bench: its figures and tables of known measurements, and what the page on speed says."""

import json

import numpy
import pytest
from mrp_bench import figures, tables
from mrp_bench.programs import Measurement
from mrp_bench.ways import PLAN, WAYS, steps
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

NODES = ("cpp_cpp", "cpp_py", "py_cpp", "py_py")


def test_percentiles_are_values_that_were_measured():
    hundred = numpy.random.default_rng(1).permutation(range(1, 101))
    assert figures.percentiles(hundred) == {"p50": 50, "p90": 90, "p99": 99, "max": 100}
    assert figures.percentiles([3, 1, 2]) == {"p50": 2, "p90": 3, "p99": 3, "max": 3}
    assert figures.percentiles([7]) == {"p50": 7, "p90": 7, "p99": 7, "max": 7}


@pytest.mark.parametrize(
    ("received", "latencies", "lost", "disordered"),
    [
        ([10, 15, 20, 26, 30, 37], [5, 6, 7], 0, 0),
        ([10, 15, 30, 37], [5, 7], 1, 0),
        ([10, 40, 30, 41, 20, 42], [30, 11, 22], 0, 1),
        ([10, 40, 20, 41, 20, 42], [30, 21, 22], 1, 1),
    ],
    ids=["all", "lost", "late", "twice"],
)
def test_delivery(received, latencies, lost, disordered):
    found = figures.delivery([10, 20, 30], received)
    assert (list(found.latencies), found.lost, found.disordered) == (latencies, lost, disordered)


def test_delivery_of_what_was_not_sent_is_an_error():
    with pytest.raises(ValueError, match="found 25, which was not"):
        figures.delivery([10, 20], [10, 11, 25, 26])


def measurement(latency, lost=(), receiver_cpu=0.02):
    """Return a Measurement of 100 messages, one each millisecond. latency: in ns"""
    sent = [1_000_000 * (i + 1) for i in range(100)]
    pairs = [(stamp, stamp + latency) for i, stamp in enumerate(sent) if i not in lost]
    return Measurement(sent, [[number for pair in pairs for number in pair]], 0.01, receiver_cpu)


@pytest.fixture
def content(monkeypatch):
    """What results.json says of three ways, which are measured in three rounds."""
    known = {
        "raw": measurement(10_000),
        "cpp_cpp": measurement(25_000, (3, 50)),
        "cpp_shared": measurement(5_000, receiver_cpu=None),
    }

    class Running:
        def __init__(self, way, log):
            self.name = way.name

        def __enter__(self):
            return self

        def __exit__(self, *exception):
            pass

        def measure(self, stream):
            return known[self.name]

    monkeypatch.setattr(figures, "Running", Running)
    plan = steps([*known], (8, 1000, 100), (8, 0, 100))
    facts = ("processor", "system", "kernel", "roscpp", "python", "cores", "gigabytes")
    robots = {"robots": 4, **dict.fromkeys(tables.ROBOTS, 30), "lost": 3}
    return {
        "machine": dict.fromkeys(facts, "some"),
        "robots": [robots],
        "rows": figures.measure(3, None, print, plan),
    }


def test_rows_of_known_measurements(content):
    limit, cpp, shared = content["rows"][-3:]
    assert [row["way"] for row in (limit, cpp, shared)] == ["raw", "cpp_cpp", "cpp_shared"]
    assert cpp["latency"] == {"p50": 25, "p90": 25, "p99": 25, "max": 25}
    assert (cpp["sent"], cpp["lost"], cpp["disordered"]) == (300, 6, 0)
    assert (cpp["latency_ratio"], limit["latency_ratio"]) == (2.5, 1)
    # From the first message's stamp to the last one's arrival: 99 ms and the latency.
    assert limit["throughput"] == pytest.approx(100 / 0.09901)
    assert cpp["throughput"] == pytest.approx(98 / 0.099025)
    assert (cpp["sender_cpu"], cpp["receiver_cpu"]) == pytest.approx((100, 200))
    assert shared["receiver_cpu"] is None


def test_table_says_what_was_measured(content):
    text = tables.markdown(content)
    same = "6 of 300 | kept | 100.00 | 200.00 |\n"
    assert f"| C++ to C++ | 25.0 | 25.0 | 25.0 | 25.0 | 2.50 | {same}" in text
    assert f"| C++ to C++ | 990 | 0.98 | {same}" in text
    assert text.endswith("| 4 | 30.00 | 30.00 | 30.00 | 30.00 | 30.00 | 30 | 30 | 3 |")


def test_results_have_one_record_per_line(content):
    text = figures.as_text(content)
    assert json.loads(text) == content
    assert sum('"way"' in line for line in text.splitlines()) == 6


# The page on speed says what the recorded figures say, recorded/results.json.


@pytest.fixture(scope="module")
def recorded():
    return json.loads((WORKSPACE / "src/mrp/doc/recorded/results.json").read_text())


@pytest.fixture(scope="module")
def rows(recorded):
    """(way, size, rate) -> what was measured. A rate of 0 is as fast as it goes."""
    return {(row["way"], row["size"], row["rate"]): row for row in recorded["rows"]}


def test_recorded_rows_are_those_of_the_plan(rows):
    assert list(rows) == sorted(
        ((way, *stream[:2]) for way, stream in PLAN),
        key=lambda key: (key[1:], [*WAYS].index(key[0])),
    )


def test_small_messages(rows):
    small = {way: rows[way, 8, 1000] for way in NODES}
    assert max(row["latency"]["p99"] for row in small.values()) < 300
    # To one decimal, as the table has it.
    ratios = [round(row["latency_ratio"], 1) for row in small.values()]
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


def test_memory_of_a_node(recorded):
    (fifty,) = (robots for robots in recorded["robots"] if robots["robots"] == 50)
    assert fifty["py"] > 20 * fifty["cpp"]
