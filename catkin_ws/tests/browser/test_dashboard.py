# SPDX-License-Identifier: BSD-3-Clause
"""Dask's dashboard, with what draws it and Debian does not have: it shows how a class goes on."""

import pytest
from mrp_check.contract import packages
from mrp_testing.cluster import DASK, cluster
from mrp_testing.nodes import program
from mrp_testing.ports import free_port
from mrp_testing.process import Process
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.xdist_group("view")

PYTHON = WORKSPACE / "build" / "dask" / "bin" / "python"
SCREENSHOT = WORKSPACE / "build" / "screenshots" / "dashboard.png"
BASE = "talker_listener_py"
STUDENTS = ("anna", "berta")
MODEL = "const model = Bokeh.documents[0]?.get_model_by_name(arguments[0]);"
RUNNING = f"{MODEL} return / processing: 1,/.test(model?.title.text)"
DONE = (
    f"{MODEL} return [...(model?.renderers[0].data_source.data.name ?? [])]"
    ".filter((name) => name !== 'start')"  # which Dask puts there before there is any
)


def test_it_shows_what_runs_and_what_is_done(tmp_path, browser):
    for name in STUDENTS:
        packages.lay_out(BASE, tmp_path / "class" / name)
    port = free_port()
    options = ("--dashboard", "--dashboard-address", f"127.0.0.1:{port}")
    dask = (str(PYTHON), *DASK)
    with cluster(tmp_path, 1, options, dask) as (_, address, _):
        browser.open(f"http://127.0.0.1:{port}/status")
        asked = ("--class", str(tmp_path / "class"), "--spec", BASE, "--scheduler", address)
        with Process(program("mrp_check", "check"), *asked) as checker:
            checker.wait_for(lambda: browser.run(RUNNING, "task_progress"), "one is shown to run")
            assert checker.wait() == 0, checker
        shown = browser.wait_until(lambda: stream(browser), "those that are done are shown")
        assert shown == ["mark"] * len(STUDENTS)
        SCREENSHOT.parent.mkdir(parents=True, exist_ok=True)
        browser.driver.save_screenshot(str(SCREENSHOT))
        # What draws it warns, on some machines, of ranges that it cannot know yet.
        faults = [line for line in browser.console() if line.startswith("SEVERE")]
        assert (faults, browser.requests()[1]) == ([], [])


def stream(browser):
    """Return the names of the tasks that mark a student, once there is one for each."""
    # A busy machine shows there, too, what the scheduler itself spends time on.
    names = [name for name in browser.run(DONE, "task_stream") or [] if name == "mark"]
    return names if len(names) >= len(STUDENTS) else None
