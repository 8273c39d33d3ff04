# SPDX-License-Identifier: BSD-3-Clause
"""make bench: its statistics on known data, its report, and every way's messages."""

import csv
import json
import os
import signal
import subprocess
import sys
import threading
import uuid
import xml.etree.ElementTree as ElementTree

import numpy
import pytest
import record_bench
import rosgraph
import yaml
from mrp_bench import (
    fan_figures,
    fans,
    launch_figures,
    launches,
    noise,
    plans,
    plots,
    report,
    rounds,
    stats,
    summary,
    svg,
    tables,
)
from mrp_bench.comparisons import COMPARISONS
from mrp_bench.master import Master
from mrp_bench.processes import cpu
from mrp_bench.programs import Measurement, ProgramError, Running, Slice
from mrp_bench.ways import LIMITS, WAYS, Way
from mrp_testing.process import Process, processes_with
from mrp_testing.proves import proves
from mrp_testing.waiting import wait_until
from rospy.impl import tcpros_pubsub

pytestmark = pytest.mark.quick


def test_percentiles_are_values_that_were_measured():
    hundred = numpy.random.default_rng(1).permutation(range(1, 101))
    assert stats.percentiles(hundred) == {"p50": 50, "p90": 90, "p99": 99, "max": 100}
    assert stats.percentiles([3, 1, 2]) == {"p50": 2, "p90": 3, "p99": 3, "max": 3}
    assert stats.percentiles([7]) == {"p50": 7, "p90": 7, "p99": 7, "max": 7}


def test_percentiles_of_nothing_are_an_error():
    with pytest.raises(ValueError, match="expected at least one value"):
        stats.percentiles([])


def test_delivery_in_order_and_whole():
    found = stats.delivery([10, 20, 30], [10, 15, 20, 26, 30, 37])
    assert (list(found.latencies), found.lost, found.disordered) == ([5, 6, 7], 0, 0)


def test_delivery_counts_what_is_lost():
    found = stats.delivery([10, 20, 30], [10, 15, 30, 37])
    assert (list(found.latencies), found.lost, found.disordered) == ([5, 7], 1, 0)
    assert stats.delivery([10, 20], []).lost == 2


def test_delivery_counts_what_comes_late_or_twice():
    assert stats.delivery([10, 20, 30], [10, 40, 30, 41, 20, 42]).disordered == 1
    twice = stats.delivery([10, 20], [10, 40, 20, 41, 20, 42])
    assert (twice.lost, twice.disordered) == (0, 1)


def test_delivery_of_what_was_not_sent_is_an_error():
    with pytest.raises(ValueError, match="found 25, which was not"):
        stats.delivery([10, 20], [10, 11, 25, 26])


def exponential(count, median, number):
    """Return latencies as they are measured: some far above the median."""
    values = numpy.random.default_rng(number).exponential(size=count)
    return list(median * (0.8 + 0.2 * values / numpy.log(2)))


def test_ratio_of_known_distributions():
    ours = [exponential(500, 30, number) for number in range(6)]
    limit = [exponential(500, 12, number + 6) for number in range(6)]
    found = stats.ratio(ours, limit)
    assert found.low < 2.5 < found.high
    assert found.value == pytest.approx(2.5, rel=0.05)
    assert found.high / found.low < 1.1
    assert stats.ratio(ours, limit) == found


@proves(
    '"x" is the ratio to raw TCP in the same rounds, and in brackets the interval in which the '
    "true ratio lies in 95 of 100 cases.",
)
@pytest.mark.slow
def test_interval_of_ratio_has_the_true_value_as_often_as_it_says():
    """In 95 of 100, or about; the rounds are six, and each is slower or faster as a whole."""
    hits = 0
    for number in range(100):
        random = numpy.random.default_rng(1000 + number)
        factors = random.lognormal(sigma=0.2, size=6)
        medians = numpy.outer([30, 12], factors) * random.lognormal(sigma=0.05, size=(2, 6))
        ours, limit = (
            [exponential(60, median, random.integers(1 << 30)) for median in side]
            for side in medians
        )
        found = stats.ratio(ours, limit)
        hits += found.low <= 2.5 <= found.high
    assert 88 <= hits


def test_interval_of_ratio_is_wide_when_rounds_differ():
    limit = [exponential(100, 10, number) for number in range(4)]
    steady = [exponential(100, 20, number + 4) for number in range(4)]
    unsteady = [exponential(100, 10 * 2**number, number + 8) for number in range(4)]
    assert not tables.is_noisy(stats.ratio(steady, limit))
    assert tables.is_noisy(stats.ratio(unsteady, limit))


def test_ratio_needs_the_same_rounds():
    with pytest.raises(ValueError, match="expected the same number of rounds, found 2 and 1"):
        stats.ratio([[1], [2]], [[1]])
    with pytest.raises(ValueError, match="at least one value in each round"):
        stats.ratio([[1], []], [[1], [1]])


def test_exponent_of_known_growth():
    sizes = [1, 2, 5, 10, 20, 50]
    found = stats.exponent(sizes, [3 * size**1.5 for size in sizes])
    assert found == pytest.approx((1.5, 1.5, 1.5))
    random = numpy.random.default_rng(2)
    noisy = [3 * size * random.lognormal(sigma=0.1) for size in sizes]
    found = stats.exponent(sizes, noisy)
    assert found.low < 1 < found.high
    assert found.value == pytest.approx(1, abs=0.1)


def test_exponent_needs_three_sizes():
    with pytest.raises(ValueError, match="three different sizes"):
        stats.exponent([1, 1, 2], [1, 1, 2])


def test_noise_is_the_time_in_long_gaps():
    steady = list(range(0, 1_000_000, 100))
    assert noise.lost_share(steady) == 0
    interrupted = steady + [moment + 2_000_000 for moment in steady]
    assert noise.lost_share(interrupted) == pytest.approx(1 / 3, abs=0.001)


def test_noise_is_judged_by_most_probes():
    assert noise.verdict([0.0, 0.01, 0.9]) is None
    assert "others took 60% of the processors' time" in noise.verdict([0.5, 0.6, 0.9])


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


@pytest.mark.parametrize("plan", [plans.QUICK, plans.FULL])
def test_every_way_is_measured_beside_its_limit(plan):
    assert {step.way for step in plan} <= set(WAYS)
    for step in plan:
        beside = {one.way for one in plan if one.piece[:2] == step.piece[:2]}
        assert {"raw_cpp", "raw_py"} <= beside, step
    assert len({(step.way, *step.piece[:2]) for step in plan}) == len(plan), (
        "something is there twice"
    )


@proves("make bench QUICK=1 measures less.")
def test_full_plan_has_every_way():
    assert {step.way for step in plans.FULL} == set(WAYS)
    assert len(plans.QUICK) < len(plans.FULL)


@pytest.fixture
def master(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", os.environ.get("ROS_MASTER_URI", ""))
    with Master(tmp_path / "master.log"):
        yield


@proves("Every way delivers every message in order, as long as the queues are unlimited.")
@pytest.mark.slow
def test_every_way_delivers_every_message_in_order(master, tmp_path):
    plan = rounds.steps(WAYS, (8, 200, 10))
    plan += rounds.steps([way for way in WAYS if "rostopic" not in way], (70000, 0, 3))
    results = rounds.Results(tmp_path)
    results.begin(plan, 1, resume=False)
    rounds.run(plan, 1, results, print)
    found = results.measurements()
    assert len(found) == len(plan)
    for one in found:
        assert len(one["received"]) == WAYS[one["way"]].receivers
        for pairs in one["received"]:
            assert pairs[::2] == one["sent"], one["way"]
            assert all(arrival > stamp for stamp, arrival in zip(pairs[::2], pairs[1::2]))
        assert one["sender_cpu"] > 0
        assert WAYS[one["way"]].receiver is None or one["receiver_cpu"] > 0


@proves(
    "It also prints how long it will still take.",
    "It measures all ways in turns, round after round, so that background load affects all of "
    "them equally.",
    "If you stop a run, make bench RESUME=1 continues it.",
)
@pytest.mark.slow
def test_a_run_goes_on_where_it_ended(tmp_path):
    plan = rounds.steps(LIMITS, (8, 200, 10), (70000, 0, 3))
    results = rounds.Results(tmp_path)
    results.begin(plan, 4, resume=False)
    with pytest.raises(KeyboardInterrupt):
        rounds.run(plan, 4, results, interrupt_at("[5/"))
    kept = {path: path.stat().st_mtime_ns for path in tmp_path.glob("samples/*/*")}
    assert len(kept) == 5

    results.begin(plan, 4, resume=True)
    lines = []
    rounds.run(plan, 4, results, lines.append)
    steps = [line for line in lines if line.startswith("[")]
    assert [line.split(" of 4")[0][-1] for line in steps] == [*"2223333", *"4444"]
    assert [line.split(": ")[1].split(",")[0] for line in steps[3:7]] == [*LIMITS] * 2
    assert all(line.endswith(" s left") for line in steps)
    assert steps[-1].startswith("[11/11] round 4 of 4: raw_py, 68 kB as fast as it goes")
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert len(results.measurements()) == 16


def interrupt_at(beginning):
    """Return a function that raises KeyboardInterrupt when it is called with such a line."""

    def say(line):
        if line.startswith(beginning):
            raise KeyboardInterrupt

    return say


def test_another_plan_cannot_be_resumed(tmp_path):
    results = rounds.Results(tmp_path)
    results.begin(rounds.steps(["raw_cpp"], (8, 0, 1)), 1, resume=False)
    with pytest.raises(rounds.PlanError, match="found another plan: begin anew"):
        results.begin(rounds.steps(["raw_cpp"], (8, 0, 2)), 1, resume=True)


@pytest.mark.slow
def test_program_that_ends_is_an_error(tmp_path, monkeypatch):
    ends = Way("ends", "ends", ("bench_raw", "send=1"), ("bench_raw.py", "receive=1"))
    monkeypatch.setitem(WAYS, "ends", ends)
    results = rounds.Results(tmp_path)
    results.begin([], 1, resume=False)

    class Broken(rounds.Running):
        def measure(self, piece):
            self.senders[0].signal(signal.SIGKILL)
            return super().measure(piece)

    monkeypatch.setattr(rounds, "Running", Broken)
    with pytest.raises(ProgramError, match="expected of 'bench_raw send=.*' the answer 'sent'"):
        rounds.run(rounds.steps(["ends"], (8, 0, 1)), 1, results, print)


@proves("The same with nodelets, which one manager loads.")
@pytest.mark.slow
def test_nodelets_are_loaded_by_one_manager(master, tmp_path):
    with Running(WAYS["cpp_nodelet"], tmp_path / "log") as running:
        running.start()
        running.connect()
        running.signal(signal.SIGCONT)
        services = subprocess.check_output(["rosservice", "list"], text=True).split()
        (manager,) = {name[: -len("/list")] for name in services if name.endswith("/list")}
        listed = subprocess.check_output(["rosservice", "call", manager + "/list"], text=True)
        nodes = subprocess.check_output(["rosnode", "list"], text=True).split()
    assert yaml.safe_load(listed) == {"nodelets": [manager + "_Receiver", manager + "_Sender"]}
    assert nodes == [manager, "/rosout"]


@pytest.mark.parametrize("name", COMPARISONS)
def test_comparison_has_ways_that_exist(name):
    _, (size, rate, count), ways = COMPARISONS[name]
    assert size >= 8 and rate >= 0 and count > 0
    assert set(ways) <= set(WAYS) and len(ways) >= 2


@proves("compare.py compares one way with the tutorial's plain code, and prints a table.")
@pytest.mark.slow
def test_comparison_prints_a_table():
    with Process("rosrun", "mrp_bench", "compare.py", "direct_queue") as comparing:
        assert comparing.wait() == 0, str(comparing)
    lines = [line for line in comparing.lines if line.startswith("| C++")]
    texts = [WAYS[name].text for name in ("cpp_cpp", "cpp_direct")]
    assert [line.split(" | ")[0] for line in lines] == ["| " + text for text in texts]
    assert all(line.split(" | ")[7:9] == ["0", "kept"] for line in lines), lines


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments", ["", "direct", "8 9 x cpp_cpp", "8 9 5 cpp_cppp", "7 9 5 cpp_cpp"]
)
def test_compare_says_what_it_expects(arguments):
    command = ["rosrun", "mrp_bench", "compare.py", *arguments.split()]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1
    assert "Usage: compare.py NAME, as in `compare.py direct_queue`\n" in done.stderr
    assert "\n  unqueued         rospy's queue_size=None: " in done.stderr
    assert "The ways are: raw_cpp, raw_py, cpp_cpp, " in done.stderr
    assert "Traceback" not in done.stderr


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
        # Of a hundred one is lost, and the others take 1 to 99 us.
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


@proves(
    "make bench starts the tutorial's launch file for up to fifty robots at once, and beside them "
    "it sends from one node to another.",
)
@pytest.mark.slow
def test_robots_start_and_stop(master, tmp_path):
    results = rounds.Results(tmp_path)
    launches.run([2], 1, results, print)
    (found,) = launches.load(results)
    names = {
        f"robot{number}/{kind}_{language}_node"
        for number in (1, 2)
        for kind in ("publisher", "subscriber")
        for language in ("cpp", "py")
    }
    for what in ("started", "ready", "stopping"):
        assert {name for _, of, name in found["events"] if of == what} == names, what
    assert found["up"] < found["stop"] < found["end"]
    assert 0 < found["cpp_megabytes"] < found["py_megabytes"]
    assert found["cores"] > 0
    assert len(found["pair"]["sent"]) == launches.PIECE.count
    assert found["pair"]["received"][::2] == found["pair"]["sent"]

    launches.run([2], 1, results, pytest.fail)


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


@pytest.fixture
def mark(monkeypatch):
    """An environment variable that no process has but those that are started from now on.

    What is left of them at the end is killed.
    """
    variable = f"MRP_TEST_MARK={uuid.uuid4()}"
    monkeypatch.setenv(*variable.split("="))
    yield variable
    for pid in processes_with(variable):
        os.kill(pid, signal.SIGKILL)


@proves(
    "make bench also measures fans: up to a hundred publishers to one subscriber, and one "
    "publisher to up to a hundred subscribers.",
    "All queues are unlimited, so messages are late and not lost.",
)
@pytest.mark.slow
def test_fans_deliver_every_message_and_leave_nothing_behind(master, mark, tmp_path, monkeypatch):
    monkeypatch.setattr(fans, "PIECE", Slice(size=8, rate=100, count=5))
    results = rounds.Results(tmp_path)
    fans.run([1, 2], results, print)
    found = fans.load(results)
    assert sorted((one["language"], one["publishers"], one["subscribers"]) for one in found) == [
        (language, *sides) for language in ("cpp", "py") for sides in ((1, 1), (1, 2), (2, 1))
    ]
    for one in found:
        assert len(one["sent"]) == 5 * one["publishers"]
        assert len(one["received"]) == one["subscribers"]
        for received in one["received"]:
            assert sorted(received[::2]) == sorted(one["sent"])
            assert all(arrival > stamp for stamp, arrival in zip(received[::2], received[1::2]))
        assert fan_figures.figures(one)["lost"] == 0
        assert one["up"] > 0 and one["sender_cpu"] > 0 and one["receiver_cpu"] > 0
        assert one["publisher_megabytes"] > 1 and one["subscriber_megabytes"] > 1
    assert not processes_with(mark)

    fans.run([1, 2], results, pytest.fail)


@proves(
    "When a C++ node ends, ros::spin asks the node's queue for callbacks until the master knows "
    "that the node has gone.",
    "By then the queue is disabled and answers at once, so each node takes a whole core.",
    "A node with this function in place of ros::spin waits without work:",
)
@pytest.mark.slow
def test_ros_spin_takes_a_core_while_its_node_ends(master):
    """And mrp_bench's spin() does not. A master that stands still keeps both from ending."""
    core = rosgraph.Master("/test_bench")
    with Process("rosrun", "mrp", "subscriber_cpp_node") as plain:
        with Process("rosrun", "mrp_bench", "bench_node", "subscribe=1", "only_small=1") as calm:
            wait_until(
                lambda: (
                    {"/great_topic", "/small"} <= {name for name, _ in core.getSystemState()[1]}
                ),
                "both have subscribed",
            )
            pid = core.getPid()
            os.kill(pid, signal.SIGSTOP)
            try:
                begin = cpu([plain.pid]), cpu([calm.pid])
                for node in (plain, calm):
                    os.kill(node.pid, signal.SIGINT)
                wait_until(lambda: cpu([plain.pid]) - begin[0] > 1, "a second of processor time")
                assert cpu([calm.pid]) - begin[1] < 0.1
            finally:
                os.kill(pid, signal.SIGCONT)
            assert [plain.wait(), calm.wait()] == [0, 0]


BENCH_THAT_WAITS = """
import pathlib, signal, sys
from mrp_bench.master import Master
from mrp_bench.programs import Running
from mrp_bench.ways import WAYS

log = pathlib.Path(sys.argv[1])
with Master(log), Running(WAYS["rostopic_pub"], log) as running:
    running.start()
    running.connect()
    print("connected", flush=True)
    signal.pause()
"""


@pytest.mark.slow
def test_nothing_outlives_a_bench_that_is_killed(mark, tmp_path):
    """A master with a child of its own, and programs that stand still, one of them with a child."""
    with Process(sys.executable, "-c", BENCH_THAT_WAITS, str(tmp_path / "log")) as bench:
        bench.wait_for(lambda: "connected" in bench.lines, "the programs are connected")
        commands = processes_with(mark).values()
        for name in ("rosmaster", "bench_node", "bench_rostopic.py", "rostopic pub"):
            assert any(name in command for command in commands), (name, commands)
        os.kill(bench.pid, signal.SIGKILL)
        wait_until(lambda: not processes_with(mark), "all have ended")


def results_of(folder, rounds_measured=6, verdict=None):
    """Make a folder as `make bench` leaves it."""
    folder.mkdir()
    content = {"verdict": verdict, "rows": [{"rounds": rounds_measured}]}
    (folder / "results.json").write_text(json.dumps(content))
    return folder


def test_record_for_the_page(tmp_path):
    folder, recorded = results_of(tmp_path / "bench"), tmp_path / "results.json"
    record_bench.record(folder, recorded)
    assert recorded.read_text() == (folder / "results.json").read_text()


def test_no_record_of_a_noisy_or_quick_or_missing_run(tmp_path):
    recorded = tmp_path / "recorded.json"
    with pytest.raises(SystemExit, match="found none: run make bench"):
        record_bench.record(tmp_path, recorded)
    with pytest.raises(SystemExit, match="error: too noisy"):
        record_bench.record(results_of(tmp_path / "noisy", verdict="too noisy"), recorded)
    with pytest.raises(SystemExit, match="expected 6 rounds, found 3: run make bench without"):
        record_bench.record(results_of(tmp_path / "quick", rounds_measured=3), recorded)
    assert not recorded.exists()


@proves(
    "A Python publisher with a queue calls time.sleep(0) after each message, so that its sending "
    "thread gets its turn.",
)
def test_rospy_sleeps_after_each_message_that_it_queues(monkeypatch):
    """What the page says of time.sleep(0)."""

    class Connection:
        done = False
        written = []

        def set_cleanup_callback(self, callback):
            self.wake_up = callback

        def write_data(self, data):
            self.written.append(data)

    connection = Connection()
    before = threading.enumerate()
    queued = tcpros_pubsub.QueuedConnection(connection, 0)
    (sending,) = {*threading.enumerate()} - {*before}
    sleeps = []
    monkeypatch.setattr(tcpros_pubsub.time, "sleep", sleeps.append)
    try:
        for number in range(3):
            queued.write_data(number)
        assert sleeps == [0, 0, 0]
    finally:
        monkeypatch.undo()
        wait_until(lambda: connection.written == [0, 1, 2], "the sending thread has sent all")
        connection.done = True
        connection.wake_up(connection)
        sending.join()
