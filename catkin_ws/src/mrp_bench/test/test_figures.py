# SPDX-License-Identifier: BSD-3-Clause
"""make bench: its tables of known measurements, and what the page on speed says of a run's."""

import csv

import numpy
import pytest
from mrp_bench import figures
from mrp_bench.running import Measurement
from mrp_bench.ways import PAIRS, PLAN, WAYS, size_text
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

RECORDED = WORKSPACE / "src" / "mrp" / "doc" / "recorded" / "speed"


def measurement(latency, throughput, receiver_cpu):
    return Measurement(numpy.full(50, latency), throughput, 1.5, receiver_cpu)


@pytest.fixture
def tables():
    found = {}
    for rate in (1000, 0):
        found["cpp_cpp", 8, rate] = [measurement(*of) for of in ((20, 900, 2), (30, 1234, 4))]
        found["cpp_shared", 8, rate] = [measurement(5, 4000, None)]
        found["raw", 8, rate] = [measurement(10, 2000, 1)]
    return figures.tables(found)


def test_tables_of_known_measurements(tables):
    raw, cpp, shared = tables["latency"][1:]
    assert raw[:-2] == ["raw TCP", "8 B", "1000", "10.0", "10.0", "10.0", "1.0"]
    assert cpp == ["C++ to C++", "8 B", "1000", "25.0", "30.0", "30.0", "2.5", "1.50", "3.00"]
    assert shared[-3:] == ["0.5", "1.50", "the same"]
    assert tables["throughput"][2] == ["C++ to C++", "8 B", "1 067", "0.53", "1.50", "3.00"]
    assert tables["summary"][2] == ["C++ to C++", "25.0", "30.0", "2.5", "1 067"]


def test_table_is_written_and_shown(tables, tmp_path):
    figures.write(tables["summary"], tmp_path / "table.csv")
    with open(tmp_path / "table.csv") as file:
        assert list(csv.reader(file)) == tables["summary"]
    assert figures.aligned([["a", "b"], ["long", "c"]]) == "a     b\nlong  c"


# The page on speed says what the recorded tables say.


def recorded(name):
    """Return the rows of a table, without its head."""
    with open(RECORDED / f"{name}.csv") as file:
        return list(csv.reader(file))[1:]


def numbers(cells):
    return [float(cell.replace(" ", "")) for cell in cells]


def latency(way, size):
    """Return p50, p99, the longest latency, the ratio and the sender's processor time."""
    (row,) = (row for row in recorded("latency") if row[:2] == [WAYS[way].text, size])
    return numbers(row[3:8])


def per_second(way):
    (row,) = (row for row in recorded("throughput") if row[:2] == [WAYS[way].text, "8 B"])
    return numbers(row[2:3])[0]


def test_recorded_rows_are_those_of_the_plan():
    planned = {
        name: {
            (WAYS[way].text, size_text(stream.size))
            for way, stream in PLAN
            if bool(stream.rate) == has_rate
        }
        for name, has_rate in (("latency", True), ("throughput", False))
    }
    assert {name: {tuple(row[:2]) for row in recorded(name)} for name in planned} == planned
    assert [row[0] for row in recorded("summary")] == [WAYS[way].text for way in PAIRS]


def test_small_messages():
    small = {way: latency(way, "8 B") for way in PAIRS[1:]}
    assert max(p99 for _, p99, *_ in small.values()) < 300
    ratios = [ratio for *_, ratio, _ in small.values()]
    assert 2 <= min(ratios) and max(ratios) <= 5
    assert small["cpp_py"][0] < small["cpp_cpp"][0]


def test_messages_per_second():
    slow = max(per_second("py_cpp"), per_second("py_py"))
    assert min(per_second("cpp_cpp"), per_second("cpp_py")) > 10 * slow
    assert per_second("py_timer_slack") > 2 * per_second("py_py")
    assert per_second("py_unqueued") > 10 * per_second("py_py")
    assert per_second("cpp_batch") > 20 * per_second("cpp_cpp")


def test_tcp_no_delay():
    ratio = latency("cpp_no_delay", "8 B")[0] / latency("cpp_cpp", "8 B")[0]
    assert ratio == pytest.approx(1, abs=0.1)
    assert latency("cpp_cpp", "1 kB")[1] > 10_000
    assert latency("cpp_no_delay", "1 kB")[2] < 10_000


def test_four_subscribers():
    for single, four in (("cpp_cpp", "cpp_to_4"), ("py_py", "py_to_4")):
        assert latency(four, "8 B")[4] < 4 * latency(single, "8 B")[4]


def test_memory_of_a_node():
    (fifty,) = (row for row in recorded("robots") if row[0] == "50")
    cpp, py = numbers(fifty[4:])
    assert py > 20 * cpp
