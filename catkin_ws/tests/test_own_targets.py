# SPDX-License-Identifier: BSD-3-Clause
"""make own-times and make docker-size: when they say that something has grown."""

import json

import history
import image_size
import own_times
import pytest
import timed

pytestmark = pytest.mark.quick

LAST = {
    "commit": "last",
    "debian": "12",
    "stage": "build",
    "node": "2.0",
    "seconds": "30",
    "processor": "50",
    "tests": "0",
}


def found(**figures):
    """Return what is said of a stage that took that now, where it is in the history as LAST."""
    return own_times.regressions([LAST], [{**LAST, "commit": "now", **figures}])


def test_work_grows_by_half_in_times_of_compiling_a_node():
    assert found(processor="76") == [
        "build: expected about 30 s and 50 s of processor time, as at last where a node took 2.0 s "
        "to compile; found 30 s and 76 s, a node 2.0 s"
    ]
    assert found(processor="74") == []
    assert found(processor="76", node="2.1") == [], "a slower machine"
    assert found(processor="60", node="1.5") != [], "a faster machine"
    assert found(processor="500", stage="something new") == []


def test_waiting_grows_by_half_in_seconds_and_in_times_of_compiling_a_node():
    assert found(seconds="46") != []
    assert found(seconds="44") == []
    assert found(seconds="30", processor="30", node="1.2") == [], "a faster machine waits as long"
    assert found(seconds="60", processor="100", node="4.0") == [], "a slower machine"


def test_tests_become_fewer():
    before = [{**LAST, "stage": "number of tests", "tests": "9"}]

    def said(tests):
        return own_times.regressions(before, [{**before[0], "tests": tests}])

    assert said(8) == ["number of tests: expected 9 or more, found 8"]
    assert said(9) == said(10) == []


def test_cases_are_counted_once(tmp_path):
    suites = {
        "pytest_quick.xml": 2,
        "pytest_slow.xml": 3,
        "mrp_labs/rosunit-some.xml": 4,
        "mrp_labs/rostest-some.xml": 1,
        "browser.xml": 1,
    }
    for name, cases in suites.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(f"<testsuite>{'<testcase/>' * cases}</testsuite>")
    assert own_times.count_tests(tmp_path) == 2 + 3 + 4


def test_processor_time_is_that_of_all_descendants():
    compute = "/usr/bin/python3 -c 'sum(range(20_000_000))'"
    code, _, processor = timed.run("sh", "-c", f"{compute} & {compute} & wait; exit 3")
    assert code == 3
    assert processor > 10 * timed.run("true")[2]


def test_a_stage_is_kept_beside_the_others(tmp_path, monkeypatch):
    monkeypatch.setattr(timed, "TIMES", tmp_path / "build" / "times.json")
    assert timed.main("build", "true") == 0
    assert timed.main("tests", "sh", "-c", "kill -INT $$") == 130
    assert timed.main("build", "false") == 1
    assert sorted(json.loads(timed.TIMES.read_text())) == ["build", "tests"]


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
