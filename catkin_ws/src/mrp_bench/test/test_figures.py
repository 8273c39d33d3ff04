# SPDX-License-Identifier: BSD-3-Clause
"""make bench: gives it known measurements, and checks its tables."""

import json

import pytest
from mrp_bench import launches, machine, report, rounds, summary, tables
from mrp_bench.programs import Measurement

pytestmark = pytest.mark.quick


def measurement(way, number, latency, rate=1000, lost=(), receiver_cpu=0.02):
    sent = [1_000_000 * (i + 1) for i in range(100)]
    pairs = [(stamp, stamp + latency) for i, stamp in enumerate(sent) if i not in lost]
    return {
        "way": way,
        "size": 8,
        "rate": rate,
        "count": 100,
        "round": number,
        "sender_cpu": 0.01,
        "receiver_cpu": receiver_cpu,
        "sent": sent,
        "received": [[number for pair in pairs for number in pair]],
    }


@pytest.fixture
def measurements():
    return [
        measurement(way, number, latency * 1000, rate, lost, cpu)
        for number in range(3)
        for rate in (0, 1000)
        for way, latency, lost, cpu in (
            ("raw_cpp", 10, (), 0.02),
            ("cpp_cpp", 25, (3, 50), 0.02),
            ("cpp_shared", 5, (), None),
        )
    ]


def test_summary_of_known_samples(measurements):
    limit, cpp, shared = summary.summarise(measurements)[-3:]
    assert [row.way for row in (limit, cpp, shared)] == ["raw_cpp", "cpp_cpp", "cpp_shared"]
    assert cpp.latency == {"p50": 25, "p90": 25, "p99": 25, "max": 25}
    assert (cpp.sent, cpp.lost, cpp.disordered) == (300, 6, 0)
    assert cpp.latency_ratio == {"raw_cpp": (2.5, 2.5, 2.5)}
    assert limit.latency_ratio == {}
    # From the first message's stamp to the last one's arrival: 99 ms and the latency.
    assert limit.throughput == pytest.approx(100 / 0.09901)
    assert cpp.throughput == pytest.approx(98 / 0.099025)
    assert (cpp.sender_cpu, cpp.receiver_cpu) == pytest.approx((100, 200))
    assert shared.receiver_cpu is None


def content_of(measurements=(), starts=(), verdict=None):
    """Return what results.json says of these."""
    facts = ("processor", "system", "kernel", "roscpp", "python")
    content = {
        "machine": {"cores": "2", "gigabytes": "6", **dict.fromkeys(facts, "some")},
        "noise": {"least": 0.01, "most": 0.5, "probes": 2},
        "verdict": verdict,
        "rows": [row._asdict() for row in summary.summarise(measurements)],
        "robots": launches.summarise(starts),
    }
    # As the pages read it.
    return json.loads(json.dumps(content))


def test_table_says_what_was_measured(measurements):
    text = report.markdown(content_of(measurements))
    assert "too noisy" not in text
    assert (
        "| C++ to C++ | 25.0 | 25.0 | 25.0 | 25.0 | 2.50 [2.50, 2.50] |  | 6 of 300 | kept "
        "| 100.00 | 200.00 |\n"
    ) in text
    cells = ["C++ to C++", "990", "0.98 [0.98, 0.98]", "", "6 of 300", "kept", "100.00", "200.00"]
    assert "| " + " | ".join(cells) + " |\n" in text


def test_table_has_no_figures_of_a_noisy_machine(measurements):
    text = report.markdown(content_of(measurements, verdict=machine.verdict([0.5])))
    assert "**This machine is too noisy: others took 50% of the processors' time" in text
    cells = ["C++ to C++", *["too noisy"] * 5, "", "6 of 300", "kept", *["too noisy"] * 2]
    assert "| " + " | ".join(cells) + " |\n" in text
    assert "25.0" not in text


@pytest.mark.slow
def test_report_is_in_all_files(measurements, tmp_path):
    results = rounds.Results(tmp_path)
    results.keep_noise(0.01)
    for measurement in measurements:
        step = rounds.steps([measurement["way"]], (8, measurement["rate"], 100))[0]
        names = ("sent", "received", "sender_cpu", "receiver_cpu")
        found = Measurement(**{name: measurement[name] for name in names})
        results.keep(measurement["round"], step, found)
    report.write(results, print)
    content = json.loads((tmp_path / "results.json").read_text())
    assert content["verdict"] is None
    assert [row["latency"]["p50"] for row in content["rows"]] == [10, 25, 5] * 2
    # One record per line.
    assert sum('"way"' in line for line in (tmp_path / "results.json").open()) == 6
    assert "| C++ to C++ | 25.0 " in (tmp_path / "table.md").read_text()


def start(robots, up):
    return {
        "robots": robots,
        "ready": {},
        "up": up,
        "stop": 100,
        "end": 103,
        "cores": 0.01 * robots**2,
        "cpp_megabytes": 2,
        "py_megabytes": 30,
        # One message of a hundred is lost, and the others take 1 to 99 us.
        "pair": {
            "sent": list(range(1, 101)),
            "received": [number for i in range(1, 100) for number in (i, i + 1000 * i)],
        },
    }


@pytest.mark.slow
def test_figures_of_many_robots():
    starts = [start(robots, up * robots) for robots in (1, 2, 4) for up in (1, 2, 9)]
    figures = launches.medians(starts)
    assert figures[4] == {
        **{"up": 8, "down": 3, "cores": pytest.approx(0.16), "cpp": 2, "py": 30},
        **{"p50": 50, "p99": 99},
    }
    (table,) = tables.robots(content_of(starts=starts))
    assert table.rows[2] == ["4", "8.00", "3.00", "0.16", "2.00", "30.00", "50", "99", "3"]
    (noisy,) = tables.robots(content_of(starts=starts, verdict="noisy"))
    assert noisy.rows[2] == ["4", *["too noisy"] * 7, "3"]
