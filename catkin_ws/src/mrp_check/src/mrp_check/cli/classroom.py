# SPDX-License-Identifier: BSD-3-Clause
"""A whole class at once: `check --class DIR`, where each folder or archive in DIR is one student's.

A process of its own checks each package, and several run at the same time. If one fails, the others
go on. The folder DIR.checked, beside DIR, keeps their reports: after Ctrl-C the same command goes
on from there. A package is checked again only if it, the checker, or what the contract asks of it
has changed.
"""

from __future__ import annotations

import concurrent.futures
import hashlib
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

from mrp_check import confine
from mrp_check.check import scratch_folder
from mrp_check.confined import cpp_headers, variables
from mrp_check.contract import resources, spec
from mrp_check.contract.errors import CannotCheck, PackageError
from mrp_check.contract.verdict import UNCHECKED, unchecked
from mrp_check.report import json_
from mrp_check.report.class_table import Submission
from mrp_check.student import submissions
from mrp_check.student.package import Package

JOBS = 2
_HERE = pathlib.Path(__file__).resolve().parents[1]
_CHUNK = 2**20  # bytes that are read at once
_MOST_NAMED = 4  # in the sentence on the progress
_GRACE = 60  # seconds that a check may take beyond its own limit


class Classroom:
    """All submissions of a class.

    folder: each folder and each file in it is a submission
    spec_file: the contract
    jobs: how many are checked at the same time
    timeout: seconds that the check of one may take
    progress: called with a sentence
    package: which is checked of a submission that has several
    results: where the reports are kept

    Raises PackageError if there is no submission.
    """

    def __init__(self, folder, spec_file, jobs=JOBS, timeout=120, progress=print, package=""):
        self.entries = submissions.entries(folder)
        self.package = package
        self.spec_file = pathlib.Path(spec_file).resolve()
        self.jobs, self.timeout, self.progress = jobs, timeout, progress
        path = pathlib.Path(folder).resolve()
        self.results = path.with_name(path.name + ".checked")
        self._running, self._stopped, self._lock = set(), False, threading.Lock()
        self._common, self._begun, self._now, self._ended = {}, 0.0, [], 0
        self._headers, self._reading = pathlib.Path(), threading.Lock()

    def check(self):
        """Check all that must be; return a Submission of each, in the order of their names."""
        self.results.mkdir(parents=True, exist_ok=True)
        self._common, self._begun = self._depended_on(), time.monotonic()
        with tempfile.TemporaryDirectory(prefix="mrp_check_class_") as folder:
            self._headers = pathlib.Path(folder) / "ros.pch"
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                futures = [pool.submit(self._checked, entry) for entry in self.entries]
                try:
                    for number, future in enumerate(concurrent.futures.as_completed(futures), 1):
                        self._say(number, future.result())
                except BaseException:  # such as Ctrl-C
                    for future in futures:
                        future.cancel()
                    self._stop()
                    raise
        return [future.result() for future in futures]

    def _say(self, number, one):
        kept = ", as before" if one.kept else ""
        said = [f"{number} of {len(self.entries)}: {one.name}: {one.report['verdict']}{kept}"]
        left = len(self.entries) - number
        if left and self._ended:
            minutes = minutes_left(time.monotonic() - self._begun, self._ended, left)
            said.append(f"about {minutes} min left")
        if self._now:
            said.append(f"now: {', '.join(self._now[:_MOST_NAMED])}")
        self.progress("; ".join(said))

    def _checked(self, entry):
        """Return a Submission, whatever happens: what is wrong with one stops no other."""
        try:
            return self._submission(entry)
        except (PackageError, CannotCheck) as error:
            reason = str(error)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
        return Submission(entry.name, json_.data(unchecked(reason)))

    def _submission(self, entry):
        with scratch_folder() as scratch:
            packed = submissions.archives(entry)
            package = None if packed else self._package(entry, scratch)
            depends_on = {"package": self._fingerprint(packed, package), **self._common}
            file = self.results / f"{entry.name}.json"
            kept = json_.kept(file)
            if kept and kept.get("depends_on") == depends_on:
                return Submission(entry.name, kept["report"], True, depends_on)
            package = package or self._package(entry, scratch)
            self._now.append(entry.name)
            try:
                report = self.report_of(package.root, entry.name)
            finally:
                self._now.remove(entry.name)
                self._ended += 1
        if report["verdict"] != UNCHECKED:
            json_.keep(file, {"depends_on": depends_on, "report": report})
        return Submission(entry.name, report, depends_on=depends_on)

    def _package(self, entry, scratch):
        return Package(submissions.package_in(entry, scratch, self.package))

    def _depended_on(self):
        """Return what all reports depend on: a text that changes with it."""
        contract = repr(spec.read(self.spec_file).without_marks())
        checker = hashlib.sha256()
        for path in sorted([*_HERE.rglob("*.py"), *resources.folder("templates").iterdir()]):
            checker.update(path.read_bytes())
        return {
            "contract": hashlib.sha256(contract.encode()).hexdigest(),
            "checker": checker.hexdigest(),
        }

    def _fingerprint(self, packed, package):
        """Return a text that changes with the package.

        For a packed submission, it is made of the archives, which are not unpacked for it.
        """
        digest = hashlib.sha256()
        of_package = [(name, package.root / name) for name in package.files] if package else []
        for name, path in [*((f"{self.package}/{one.name}", one) for one in packed), *of_package]:
            entry = path.stat()
            known = f"{name}\0{entry.st_mode & 0o111}\0{entry.st_size}\0"
            digest.update(known.encode(errors="surrogateescape"))
            with open(path, "rb") as file:
                for chunk in iter(lambda: file.read(_CHUNK), b""):
                    digest.update(chunk)
        return digest.hexdigest()

    def report_of(self, package, name):
        """Check one package in a process of its own; return its report. Raises CannotCheck.

        package: its folder
        name: the submission's
        """
        with scratch_folder() as scratch:
            command = self._command(package, name, scratch / "report.json")
            code, said = self._run(command, self._environment(scratch))
            report = json_.kept(scratch / "report.json")
        if not report:
            raise CannotCheck(said[-1] if said else f"The check ended with {code}.")
        return report

    def _command(self, package, name, report_file):
        program = "from mrp_check.cli.check import main; main()"
        command = [sys.executable, "-c", program, str(package)]
        command += [f"--spec={self.spec_file}", f"--timeout={self.timeout:g}"]
        return [*command, f"--json={report_file}", f"--html={self.results / name}.html"]

    def _environment(self, scratch):
        with self._reading:  # the first reads them for all
            if not self._headers.exists():
                cpp_headers.make(self._headers)
        env = {**os.environ, "TMPDIR": str(scratch)}
        if self._headers.exists():
            env[variables.HEADERS] = str(self._headers)
        env["PYTHONPATH"] = os.pathsep.join([str(_HERE.parent), env.get("PYTHONPATH", "")])
        return env

    def _run(self, command, env):
        """Run a command; return its exit code and the lines of its stderr. Raises CannotCheck."""
        with self._lock:
            if self._stopped:
                raise CannotCheck("The check was stopped.")
            popen = subprocess.Popen(
                command,
                env=env,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                start_new_session=True,
            )
            self._running.add(popen)
        limit = self.timeout + _GRACE
        try:
            said = popen.communicate(timeout=limit)[1]
        except subprocess.TimeoutExpired:
            _kill(popen)
            popen.communicate()
            raise CannotCheck(f"The check did not end within {limit:.0f} s.") from None
        finally:
            with self._lock:
                self._running.remove(popen)
        return popen.returncode, said.strip().splitlines()

    def _stop(self):
        with self._lock:
            self._stopped = True
            confine.stop()
            for popen in self._running:
                _kill(popen)


def minutes_left(seconds, ended, left):
    """Return how long the rest takes, at most, if so many checks ended in so many seconds."""
    return math.ceil(seconds / ended * left / 60)


def _kill(popen):
    # What it runs confined ends with it: see confine.py.
    try:
        os.killpg(popen.pid, signal.SIGKILL)
    except OSError:
        pass
