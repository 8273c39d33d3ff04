# SPDX-License-Identifier: BSD-3-Clause
"""make bench: what its tables and plots make of known measurements."""

import csv
import json
import xml.etree.ElementTree as ElementTree

import numpy
import pytest
from mrp_bench import (
    fan_figures,
    launch_figures,
    noise,
    plots,
    report,
    rounds,
    summary,
    svg,
    tables,
)
from mrp_bench.programs import Measurement
from mrp_testing.proves import proves

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
        "sender_switches": 50,
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


def content_of(measurements=(), starts=(), fans=(), verdict=None, cores=2):
    """Return what results.json says of these; machine: 2 cores, 6.4 GB."""
    facts = ("processor", "system", "kernel", "roscpp", "python")
    content = {
        "machine": {"cores": str(cores), "gigabytes": "6", **dict.fromkeys(facts, "some")},
        "noise": {"least": 0.01, "most": 0.5, "probes": 2},
        "verdict": verdict,
        "rows": [row._asdict() for row in summary.summarise(measurements)],
        "starts": {"columns": [], "missing": {}, "timeline": None},
        "robots": launch_figures.summarise(starts, cores, 6400),
        "fans": fan_figures.summarise(fans, cores),
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
    assert "| " + " | ".join(cells) + " | 0.50 |\n" in text


@proves(
    "On a machine on which others take the processors, the tables say so instead of figures.",
)
def test_table_has_no_figures_of_a_noisy_machine(measurements):
    text = report.markdown(content_of(measurements, verdict=noise.verdict([0.5])))
    assert "**This machine is too noisy: others took 50% of the processors' time" in text
    cells = ["C++ to C++", *["too noisy"] * 5, "", "6 of 300", "kept", *["too noisy"] * 2]
    assert "| " + " | ".join(cells) + " |\n" in text
    assert "25.0" not in text


@proves(
    "make bench makes the tables and plots of this page on your machine.",
    "Tables, plots and all samples are in catkin_ws/build/bench.",
)
@pytest.mark.slow
def test_report_is_in_all_files(measurements, tmp_path):
    results = rounds.Results(tmp_path)
    results.begin([], 3, resume=False)
    results.keep_noise(0.01)
    for one in measurements:
        step = rounds.steps([one["way"]], (8, one["rate"], 100))[0]
        names = ("sent", "received", "sender_cpu", "receiver_cpu", "sender_switches")
        found = Measurement(**{name: one[name] for name in names})
        results.keep(one["round"], step, found)
    report.write(results, print)
    content = json.loads((tmp_path / "results.json").read_text())
    assert content["verdict"] is None
    assert [row["latency"]["p50"] for row in content["rows"]] == [10, 25, 5] * 2
    with open(tmp_path / "results.csv", newline="") as file:
        assert [row["p50_us"] for row in csv.DictReader(file)] == ["10.00", "25.00", "5.00"] * 2
    assert "| C++ to C++ | 25.0 " in (tmp_path / "table.md").read_text()
    assert {"C++ to C++", "25.0", "raw TCP, C++", "10.0"} <= svg_texts(tmp_path / "latency.svg")
    assert {"C++ to C++", "990, 2% lost"} <= svg_texts(tmp_path / "throughput.svg")
    assert plots.latency(content).alt.endswith(", shared pointers 5.0 to C++ to C++ 25.0.")


def svg_texts(path):
    return set(ElementTree.parse(path).getroot().itertext())


def start(robots, up):
    return {
        "robots": robots,
        "events": [],
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
@proves("How the costs grow shows how many robots the machine can hold.")
def test_growth_with_the_robots():
    starts = [start(robots, up * robots) for robots in (1, 2, 4) for up in (1, 2, 9)]
    figures = launch_figures.medians(starts)
    assert figures[4] == {
        **{"up": 8, "down": 3, "cores": pytest.approx(0.16), "cpp": 2, "py": 30},
        **{"p50": 50, "p99": 99},
    }
    found = launch_figures.exponents(figures)
    assert {name: round(estimate.value, 6) for name, estimate in found.items()} == {
        "up": 1,
        "down": 0,
        "cores": 2,
        **dict.fromkeys(("cpp", "py", "p50", "p99"), 0),
    }
    (table,) = tables.robots(content_of(starts=starts))
    assert table.rows[2] == ["4", "8.00", "3.00", "0.16", "2.00", "30.00", "50", "99", "3"]
    # 0.01 of a core for the square of the robots, and 64 MB for each.
    assert table.after == ["If that goes on, 14 robots fill the 2 cores, and 100 fill the memory."]
    (noisy,) = tables.robots(content_of(starts=starts, verdict="noisy"))
    assert noisy.rows[2] == ["4", *["too noisy"] * 7, "3"]
    assert noisy.after == []
    assert launch_figures.exponents(launch_figures.medians(starts[:6])) == {}


def fan(publishers, subscribers, language="cpp", up=None, seconds=1, lost=()):
    """Return what is measured of a fan in which each link adds the same to all but the memory.

    seconds: from when the first message is sent until the last one arrives
    lost: the numbers of messages that no subscriber gets
    """
    nodes = max(publishers, subscribers)
    latency = nodes * 10_000
    sent = numpy.linspace(1, 1 + seconds * 10**9 - latency, 100 * publishers).astype(int).tolist()
    pairs = [(stamp, stamp + latency) for i, stamp in enumerate(sent) if i not in lost]
    return {
        "language": language,
        "publishers": publishers,
        "subscribers": subscribers,
        "up": nodes if up is None else up,
        "publisher_megabytes": 2,
        "subscriber_megabytes": 3,
        "sender_cpu": 0.2 * nodes,
        "receiver_cpu": 0.1 * nodes,
        "sender_switches": 0,
        "sent": sent,
        "received": [[number for pair in pairs for number in pair]] * subscribers,
    }


def test_figures_of_a_fan():
    assert fan_figures.figures(fan(1, 2, seconds=2, lost=[3, 50])) == {
        "up": 2,
        "cores": pytest.approx(0.3),
        "publisher_megabytes": 2,
        "subscriber_megabytes": 3,
        "p50": 20,
        "p99": 20,
        "per_second": pytest.approx(98),
        "sent": 200,
        "lost": 4,
    }


def test_two_publishers_may_send_at_the_same_time():
    one = {**fan(1, 1), "sent": [1, 1, 2], "received": [[1, 11, 2, 12, 1, 13]]}
    assert fan_figures.figures(one)["lost"] == 0
    one["received"] = [[1, 11, 2, 12]]
    assert fan_figures.figures(one)["lost"] == 1


@pytest.mark.slow
@proves(
    "For each cost the tables give the exponent with which it grows: with 1 a cost doubles with "
    "the number of nodes, with 0 it stays the same.",
    "They also say how many nodes fill the processors.",
)
def test_growth_of_fans():
    fans = [fan(count, 1) for count in (1, 2, 4, 8)] + [fan(1, count, up=3) for count in (2, 4, 8)]
    found = fan_figures.series(fans)
    assert {key: list(of) for key, of in found.items()} == {
        ("cpp", "publishers"): [1, 2, 4, 8],
        ("cpp", "subscribers"): [1, 2, 4, 8],
    }
    growth = fan_figures.exponents(found["cpp", "publishers"])
    assert {name: round(estimate.value, 6) for name, estimate in growth.items()} == {
        "up": 1,
        "cores": 1,
        "publisher_megabytes": 0,
        "subscriber_megabytes": 0,
        "p50": 1,
        "p99": 1,
        "per_second": 1,
    }
    publishers, subscribers = tables.fans(content_of(fans=fans))
    assert publishers.title == "C++: publishers to one subscriber"
    figures = ["2.40", "2.00", "3.00", "80", "80", "800", "0"]
    assert publishers.rows[3] == ["8", "8.00", *figures]
    assert subscribers.rows[3] == ["8", "3.00", *figures]
    assert publishers.after == ["8 publishers fill the 2 cores."]
    _, subscribers = tables.fans(content_of(fans=fans, cores=4))
    assert subscribers.after == ["8 subscribers do not fill the 4 cores."]
    assert fan_figures.exponents({1: {}, 2: {}}) == {}


@pytest.mark.slow
def test_table_of_fans_has_no_figures_of_a_noisy_machine():
    fans = [fan(count, 1, lost=[3]) for count in (1, 2, 4)]
    publishers, _ = tables.fans(content_of(fans=fans, verdict="noisy", cores=1))
    assert publishers.rows[2] == ["4", *["too noisy"] * 7, "1 of 400"]
    assert publishers.rows[3] == ["exponent", *["too noisy"] * 7, ""]
    assert publishers.after == []
    assert tables.fans(content_of()) == []


@pytest.mark.slow
@pytest.mark.parametrize("verdict", [None, "too noisy"])
def test_plot_of_fans(tmp_path, verdict):
    measured = [
        fan(*sides, language)
        for language in ("cpp", "py")
        for count in (1, 2, 4)
        for sides in {(count, 1), (1, count)}
    ]
    plots.write(content_of(fans=measured, verdict=verdict), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["fans.svg"]
    texts = svg_texts(tmp_path / "fans.svg")
    assert {"Cores in use, of 2", "Python: subscribers of one publisher", "4"} <= texts
    assert ("too noisy a machine" in texts) == (verdict is not None)


@pytest.mark.slow
def test_plot_of_robots(tmp_path):
    starts = [start(robots, robots) for robots in (1, 2, 4)]
    content = content_of(starts=starts)
    plots.write(content, tmp_path)
    assert {"all nodes ready, s: ^1.00", "cores in use: ^2.00"} <= svg_texts(tmp_path / "scale.svg")
    assert "; cores in use: ^2.00: 0.01 at 1 to 0.16 at 4; " in plots.scale(content).alt


def test_a_scale_is_logarithmic():
    scale = svg.Scale([1, 100], 0, 110)
    assert [scale(1), scale(10), scale(100)] == pytest.approx([5, 55, 105])
    assert scale.ticks() == [1, 2, 5, 10, 20, 50, 100]
    assert svg.Scale([0.01, 5000], 0, 1).ticks() == [0.01, 0.1, 1, 10, 100, 1000]
