# SPDX-License-Identifier: BSD-3-Clause
"""Checks a class on a real Dask cluster: a scheduler and workers on this machine."""

import contextlib
import csv
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import uuid

import psutil
import pytest
from check_rules import hand_in
from mrp_check.contract import resources
from mrp_check.contract.packages import lay_out
from mrp_check.package.package import MAX_BYTES
from mrp_testing.cluster import cluster, worker
from mrp_testing.process import Process, processes_with
from mrp_testing.waiting import wait_until
from test_check_stopped import command, hanging

pytestmark = pytest.mark.slow

HERE = pathlib.Path(__file__).resolve().parent
SPEC = ("--spec", "talker_listener_py")
NO_WORKER = (
    "check: The scheduler at {0} has no worker: expected one or more. Start one, and the checks"
    " continue: dask worker {0} --nthreads 1."
)


@pytest.fixture(autouse=True)
def quick(monkeypatch, tmp_path):
    """Nobody waits for long, and nothing is of the user's own Dask."""
    monkeypatch.setenv("DASK_CONFIG", str(tmp_path / "none"))
    monkeypatch.setenv("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "5s")
    monkeypatch.setenv("PYTHONPATH", ":".join(sys.path))


@pytest.fixture
def second():
    """Seconds for which a submission sleeps: a number that no other test on this machine has."""
    return f"5.{uuid.uuid4().int}"


def checked(folder, *options):
    """Check a class; return the exit code, its stderr, and the rows of the table."""
    table = folder.with_name("table.csv")
    with command("--class", folder, "--csv", table, *SPEC, *options) as checker:
        _, stderr = checker.communicate()
    assert "Traceback" not in stderr
    rows = list(csv.DictReader(table.read_text().splitlines())) if table.is_file() else []
    return checker.returncode, stderr, rows


def worker_of(text, workers):
    """Return the worker that runs a process with this text; None if no worker does."""
    for pid in processes_with(text):
        with contextlib.suppress(psutil.Error):
            above = {process.pid for process in psutil.Process(pid).parents()}
            for worker in workers:
                if worker.pid in above:
                    return worker
    return None


def kept(folder):
    """Return name -> content of all files that a class leaves, but for what it depends on."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_marks_are_those_of_one_machine(tmp_path):
    for where in ("here", "there"):
        anna = hand_in(tmp_path / where / "class", "anna")
        with open(anna / "video.mp4", "wb") as file:
            file.truncate(MAX_BYTES + 1)
        (tmp_path / where / "class" / "mrp").mkdir()
        lay_out("talker_listener_py", tmp_path / where / "class" / "mrp")
    (tmp_path / "there" / "class" / "zoe").mkdir()
    (tmp_path / "here" / "class" / "zoe").mkdir()
    here = checked(tmp_path / "here" / "class")
    with cluster(tmp_path) as (_, address, _):
        there = checked(tmp_path / "there" / "class", "--scheduler", address)
    assert (there[0], there[2]) == (here[0], here[2])
    assert {row["submission"]: row["verdict"] for row in there[2]} == {
        "anna": "findings",
        "mrp": "met",
        "zoe": "unchecked",
    }
    assert "3 of 3: " in there[1]
    found = [kept(tmp_path / where / "class.checked") for where in ("here", "there")]
    assert found[0] == found[1]
    assert {"anna.json", "anna.html", "mrp.html"} < {*found[0]}
    assert b"video.mp4" in found[0]["anna.json"]


# A worker's check that only sleeps: of what Dask does with it, that is enough.
NO_CHECK = """
import os, subprocess
from mrp_check.classroom import marking

def mark(job):
    subprocess.run(["sleep", "SECONDS"])
    return os._exit(1) if job.folder == "killer" else (REPORT, "a page")

def dask_setup(worker):
    marking.mark = mark

REPORT = {"verdict": "met", "package": "p", "spec": "s", "requirements": {}, "findings": []}
"""


def without_checks(folder, seconds="0"):
    """Return the environment of workers that check nothing, and sleep for some seconds."""
    (folder / "no_check.py").write_text(NO_CHECK.replace("SECONDS", seconds))
    return {"DASK_DISTRIBUTED__WORKER__PRELOAD": f"[{str(folder / 'no_check.py')!r}]"}


def test_a_worker_that_hangs_takes_no_marks(tmp_path, monkeypatch, second):
    """Stops one of two workers while it checks."""
    hand_in(tmp_path / "class", "anna")
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL", "1s")
    env = without_checks(tmp_path, second)
    with cluster(tmp_path, workers=2, **env) as (_, address, workers):
        options = ("--csv", tmp_path / "table.csv", *SPEC, "--scheduler", address)
        with command("--class", tmp_path / "class", *options) as checker:
            stopped = wait_until(lambda: worker_of(second, workers), "one checks it")
            os.kill(stopped.pid, signal.SIGSTOP)
            _, stderr = checker.communicate()
        stopped.stop(signal.SIGKILL)
        rows = list(csv.DictReader((tmp_path / "table.csv").read_text().splitlines()))
    assert [row["verdict"] for row in rows] == ["met"], stderr


def test_when_all_workers_are_gone_it_says_so_and_waits(tmp_path, second):
    """Kills both workers: what they ran ends too, and a third one checks the rest."""
    hand_in(tmp_path / "class", "anna", hanging(second))
    hand_in(tmp_path / "class", "berta", hanging(second))
    asked = (
        sys.executable,
        HERE.parent / "scripts" / "check",
        "--class",
        tmp_path / "class",
        *SPEC,
    )
    with cluster(tmp_path) as (_, address, workers):
        expected = [
            NO_WORKER.format(address),
            "check: There's a worker again: the checks continue.",
        ]

        def lines():
            return [line for line in checker.errors if "worker" in line]

        with Process(*map(str, asked), "--scheduler", address) as checker:
            checker.wait_for(lambda: worker_of(second, workers), "one checks")
            for process in workers:
                process.stop(signal.SIGKILL)
            checker.wait_for(lambda: lines() == expected[:1], "it says that there is none")
            with worker(address, tmp_path):
                assert (checker.wait(), lines()) == (1, expected), str(checker)
    wait_until(lambda: not processes_with(second), "what the killed workers ran has ended")


def test_a_submission_that_kills_its_workers_is_named(tmp_path, monkeypatch):
    """Two may die here, so that it does not take long; Dask's own default is three more."""
    import dask  # here: the quick tests read this file where Dask is not installed
    import distributed  # noqa: F401 (its defaults)

    assert dask.config.get("distributed.scheduler.allowed-failures") == 3
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "1")
    for name in ("anna", "killer", "zoe"):
        hand_in(tmp_path / "class", name)
    with cluster(tmp_path, workers=3, **without_checks(tmp_path)) as (_, address, workers):
        _, stderr, rows = checked(tmp_path / "class", "--scheduler", address)
        assert sum(worker.code is not None for worker in workers) == 2
    found = {row["submission"]: row["verdict"] for row in rows}
    assert found == {"anna": "met", "killer": "unchecked", "zoe": "met"}, stderr
    assert rows[1]["why"].startswith("Each worker to which it was given died or was lost.")


def test_a_scheduler_that_dies_loses_nothing(tmp_path, second):
    hand_in(tmp_path / "class", "anna")
    hand_in(tmp_path / "class", "berta", hanging(second))
    with cluster(tmp_path, workers=1) as (scheduler, address, workers):
        with command("--class", tmp_path / "class", *SPEC, "--scheduler", address) as checker:
            wait_until(lambda: worker_of(second, workers), "the worker checks the second one")
            scheduler.stop(signal.SIGKILL)
            _, stderr = checker.communicate()
        wait_until(lambda: not processes_with(second), "what the worker ran has ended")
    assert checker.returncode == 2, stderr
    assert "Traceback" not in stderr
    assert stderr.splitlines()[-1] == (
        f"check: The scheduler at {address} has ended, or can't be reached anymore. What has been"
        " checked is kept: start it and its workers, and call the same command again."
    )
    with cluster(tmp_path, workers=1) as (_, address, _):
        code, stderr, rows = checked(tmp_path / "class", "--scheduler", address)
    assert "anna: findings, as before" in stderr
    assert [row["verdict"] for row in rows] == ["findings", "findings"]


def test_a_signal_ends_what_runs_on_the_workers(tmp_path, second):
    hand_in(tmp_path / "class", "anna", hanging(f"1000{second}"))
    with cluster(tmp_path, workers=1) as (_, address, workers):
        with command("--class", tmp_path / "class", *SPEC, "--scheduler", address) as checker:
            wait_until(lambda: worker_of(second, workers), "the worker checks it")
            checker.send_signal(signal.SIGINT)
            _, stderr = checker.communicate()
        wait_until(lambda: not processes_with(second), "nothing of it runs")
        assert workers[0].code is None
    assert checker.returncode == 1
    assert "Traceback" not in stderr
    assert stderr.splitlines()[-1] == "check: stopped early; everything it started has ended, too."


def test_a_worker_with_another_checker_refuses(tmp_path):
    hand_in(tmp_path / "class", "anna")
    own = tmp_path / "mrp_check"
    for name in ("src", "templates", "schema", "contracts"):
        shutil.copytree(resources.folder(name), own / name)
    with open(own / "src" / "mrp_check" / "check.py", "a") as file:
        file.write("# another\n")
    env = {"PYTHONPATH": str(own / "src")}
    with cluster(tmp_path, workers=1, **env) as (_, address, _):
        code, stderr, rows = checked(tmp_path / "class", "--scheduler", address)
    assert (code, rows) == (2, [])
    expected = (
        "The worker at tcp://.* has another version of the checker. Install the one of this"
        " machine there, and start the worker again."
    )
    assert re.fullmatch(f"check: {expected}", stderr.splitlines()[-1])


def test_an_address_without_a_scheduler_or_a_worker(tmp_path, monkeypatch):
    monkeypatch.setenv("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "1s")
    hand_in(tmp_path / "class", "anna")
    code, stderr, _ = checked(tmp_path / "class", "--scheduler", "tcp://127.0.0.1:1")
    expected = "check: There's no Dask scheduler at tcp://127.0.0.1:1: expected one that"
    assert (code, stderr.count("\n")) == (2, 1)
    assert stderr.startswith(f"{expected} dask-scheduler has started. It says: OSError: Timed out")
    with cluster(tmp_path, workers=0) as (_, address, _):
        code, stderr, _ = checked(tmp_path / "class", "--scheduler", address)
    assert (code, stderr) == (2, f"{NO_WORKER.format(address)}\n")


def test_without_dask_the_package_is_named(tmp_path, monkeypatch):
    (tmp_path / "dask.py").write_text("raise ImportError\n")
    monkeypatch.syspath_prepend(tmp_path)
    hand_in(tmp_path / "class", "anna")
    code, stderr, _ = checked(tmp_path / "class", "--scheduler", "tcp://127.0.0.1:1")
    assert code == 2
    assert stderr == (
        "check: --scheduler needs Dask, which this machine doesn't have. Install it: sudo apt"
        " install python3-distributed.\n"
    )


def certificates(folder):
    """Make a certificate that vouches for itself, and Dask's configuration that has it."""
    folder.mkdir()
    names = ("-keyout", folder / "key.pem", "-out", folder / "cert.pem", "-subj", "/CN=class")
    make = ("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", *names)
    subprocess.run(make, check=True, capture_output=True)
    shutil.copy(folder / "cert.pem", folder / "ca.pem")
    text = (HERE / "tls.yaml").read_text().replace("/etc/dask", str(folder))
    (folder / "tls.yaml").write_text(text)
    return str(folder / "tls.yaml")


def test_with_tls_only_who_has_the_certificate_sends_work(tmp_path, monkeypatch):
    hand_in(tmp_path / "class", "anna")
    own, another = (certificates(tmp_path / who) for who in ("instructor", "stranger"))
    monkeypatch.setenv("DASK_CONFIG", own)
    env = without_checks(tmp_path)
    with cluster(tmp_path, workers=1, options=("--protocol", "tls"), **env) as (_, address, _):
        assert address.startswith("tls://")
        plain = address.replace("tls", "tcp")
        for config, to in ((another, address), ("/none", address), ("/none", plain)):
            monkeypatch.setenv("DASK_CONFIG", config)
            assert checked(tmp_path / "class", "--scheduler", to)[0] == 2
        assert not (tmp_path / "class.checked").exists()
        monkeypatch.setenv("DASK_CONFIG", own)
        _, stderr, rows = checked(tmp_path / "class", "--scheduler", address)
    assert [row["verdict"] for row in rows] == ["met"], stderr
