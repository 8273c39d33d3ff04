# SPDX-License-Identifier: BSD-3-Clause
"""make own-times and make docker-size: when they say that something has grown."""

import history
import image_size
import own_times
import pytest
from mrp_bench import stats

pytestmark = pytest.mark.quick


def rows(*values):
    names = ("commit", "debian", "what", "value", "low", "high", "seconds")
    return [dict(zip(names, row)) for row in values]


def test_times_grow_when_intervals_lie_apart_and_it_is_by_half():
    before = rows(
        ("old", "12", "clean build", "5.0", "4.9", "5.1", "1"),
        ("last", "12", "clean build", "10.0", "9.5", "10.5", "1"),
        ("other", "13", "clean build", "1.0", "0.9", "1.1", "1"),
    )

    def found(*numbers, what="clean build"):
        figure = own_times.Figure(1, stats.Estimate(*numbers))
        return own_times.regressions(before, "12", {what: figure})

    assert found(16, 14, 17) == [
        "clean build: expected about 10.00 times as long as to compile one node, found "
        "16.00 [14.00, 17.00], 60% more than at last"
    ]
    assert found(16, 10.4, 20) == [], "within the noise"
    assert found(14.9, 14.8, 15) == [], "less than half"
    assert found(5, 4, 6) == [], "faster"
    assert found(16, 14, 17, what="something new") == []


def test_tests_take_longer_when_ratio_and_seconds_have_grown():
    before = rows(("last", "12", "tests", "100", "95", "105", "300"))

    def found(seconds, value):
        figure = own_times.Figure(seconds, stats.Estimate(value, value - 5, value + 5))
        return len(own_times.regressions(before, "12", {"tests": figure}))

    assert found(480, 160) == 1
    assert found(290, 160) == 0, "a faster machine, that waits as long"
    assert found(480, 100) == 0, "a slower machine"
    assert found(440, 140) == 0, "less than half"


def test_seconds_of_the_last_make_test(tmp_path):
    assert own_times.test_seconds(tmp_path) is None
    suites = {
        "workspace.xml": '<testsuites><testsuite time="10.5"/></testsuites>',
        "mrp_labs/rosunit-some.xml": '<testsuite time="2"/>',
        "mrp_labs/rostest-some.xml": '<testsuite time="2"/>',
        "browser.xml": '<testsuite time="100"/>',
        "bookworm/containers.xml": '<testsuite time="100"/>',
    }
    for name, text in suites.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert own_times.test_seconds(tmp_path) == 12.5


def test_a_build_takes_processors_and_waiting_takes_none():
    compute = "/usr/bin/python3 -c 'sum(range(20_000_000))'"
    assert own_times.run(["sh", "-c", f"{compute} & {compute} & wait"]).cpu > 0.2
    asleep = own_times.run(["sleep", "0.5"])
    assert asleep.seconds >= 0.5 and asleep.cpu < 0.1


def test_image_grows_by_more_than_a_twentieth():
    before = [
        {"commit": commit, "image": "mrp:bookworm", "driver": driver, "megabytes": size}
        for commit, driver, size in (("a", "overlay2", "100.0"), ("b", "overlay2", "200.0"))
    ]
    assert image_size.fault(before, "mrp:bookworm", "overlay2", 209) is None
    assert image_size.fault(before, "mrp:bookworm", "overlay2", 211) == (
        "mrp:bookworm: expected about 200.0 MB, as at b, found 211.0 MB"
    )
    assert image_size.fault(before, "mrp:bookworm", "overlayfs", 211) is None
    assert image_size.fault(before, "mrp:trixie", "overlay2", 211) is None


def test_history_is_read_as_it_was_written(tmp_path):
    path = tmp_path / "history.csv"
    assert history.read(path) == []
    history.append(path, [{"what": "a", "value": "1"}, {"what": "b", "value": "2"}])
    history.append(path, [{"what": "a", "value": "3"}])
    found = history.read(path)
    assert [row["value"] for row in found] == ["1", "2", "3"]
    assert history.last(found, what="a")["value"] == "3"
    assert history.last(found, what="c") is None
