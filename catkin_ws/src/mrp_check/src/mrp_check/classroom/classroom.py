# SPDX-License-Identifier: BSD-3-Clause
"""A whole class at once: `check --class DIR`, where each folder or archive in DIR is one student's.

A process of its own checks each package, and several run at the same time, here or on the workers
of a cluster. If one fails, the others go on. The folder DIR.checked, beside DIR, keeps their
reports: after Ctrl-C the same command goes on from there. A package is checked again only if it,
the checker, or what the contract asks of it has changed.
"""

from __future__ import annotations

import concurrent.futures
import hashlib
import os
import pathlib
import uuid

from mrp_check.classroom import marking, submissions
from mrp_check.classroom.class_table import Submission
from mrp_check.contract import spec
from mrp_check.contract.errors import CannotCheck, ClusterError, PackageError
from mrp_check.contract.names import printable
from mrp_check.contract.verdict import UNCHECKED, unchecked
from mrp_check.package.package import Package
from mrp_check.report import json_
from mrp_check.sandbox import confine
from mrp_check.sandbox.scratch import scratch_folder

MOST_JOBS = 64
# One more than there are processors: a check waits at times, as for a node's next message.
JOBS = min(len(os.sched_getaffinity(0)) + 1, MOST_JOBS)
_CHUNK = 2**20  # bytes that are read at once


def quiet(sentence, done, of):
    """Say nothing."""


class Classroom:
    """All submissions of a class.

    folder: each folder and each file in it is a submission
    spec_file: the contract
    jobs: how many are checked at the same time; if not given, as many as the machines can
    timeout: seconds that the check of one may take
    progress: called with a sentence, and how many are done of how many
    package: which is checked of a submission that has several
    results: where the reports are kept

    Raises PackageError if there's no submission.
    """

    def __init__(self, folder, spec_file, jobs=None, timeout=120, progress=quiet, package=""):
        self.entries = submissions.entries(folder)
        self.package = package
        self.spec_file = pathlib.Path(spec_file).resolve()
        self.jobs, self.timeout, self.progress = jobs, timeout, progress
        self._machines, self._id = marking, uuid.uuid4().hex
        path = pathlib.Path(folder).resolve()
        self.results = path.with_name(path.name + ".checked")
        self._common = {}

    def check(self, cluster=None):
        """Check all that must be; return a Submission of each, in the order of their names.

        cluster: the machines that check, as a cluster.Cluster; this one if there is none

        Raises ClusterError.
        """
        self._machines = cluster or marking
        jobs = self.jobs or (cluster.threads if cluster else JOBS)
        self.results.mkdir(parents=True, exist_ok=True)
        contract = repr(spec.read(self.spec_file).without_marks())
        self._common = {  # what all reports depend on
            "contract": hashlib.sha256(contract.encode()).hexdigest(),
            "checker": marking.checker(),
        }
        self.progress(f"at most {jobs} at a time", 0, len(self.entries))
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(self._checked, entry) for entry in self.entries]
            try:
                for number, future in enumerate(concurrent.futures.as_completed(futures), 1):
                    result = future.result()
                    text = f"{result.name}: {result.report['verdict']}{', as before' * result.kept}"
                    self.progress(text, number, len(self.entries))
            except BaseException:  # such as Ctrl-C, or a cluster that is gone
                for future in futures:
                    future.cancel()
                confine.stop()
                self._machines.stop(self._id)
                raise
        return [future.result() for future in futures]

    def _checked(self, entry):
        """Return a Submission, whatever happens: what is wrong with one stops no other."""
        try:
            return self._submission(entry)
        except ClusterError:
            raise
        except (PackageError, CannotCheck) as error:
            reason = str(error)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
        return Submission(printable(entry.name), json_.data(unchecked(printable(reason))))

    def _submission(self, entry):
        name = printable(entry.name)
        with scratch_folder() as scratch:
            packed = submissions.archives(entry)
            package = None if packed else self._package(entry, scratch)
            depends_on = {"package": self._fingerprint(packed, package), **self._common}
            file = self.results / f"{name}.json"
            kept = json_.kept(file)
            if kept and kept.get("depends_on") == depends_on:
                return Submission(name, kept["report"], True, depends_on)
            package = package or self._package(entry, scratch)
            report = self.report_of(package, name)
        if report["verdict"] != UNCHECKED:
            json_.keep(file, {"depends_on": depends_on, "report": report})
        return Submission(name, report, depends_on=depends_on)

    def _package(self, entry, scratch):
        return Package(submissions.package_in(entry, scratch, self.package))

    def _fingerprint(self, packed, package):
        """Return a text that changes with the package.

        For a packed submission, it is made of the archives, which are not unpacked for it.
        """
        digest = hashlib.sha256()
        files = [*package.files, *package.not_utf8] if package else []
        of_package = [(name, package.root / name) for name in files]
        for name, path in [
            *((f"{self.package}/{archive.name}", archive) for archive in packed),
            *of_package,
        ]:
            entry = path.stat()
            known = f"{name}\0{entry.st_mode & 0o111}\0{entry.st_size}\0"
            digest.update(known.encode(errors="surrogateescape"))
            with open(path, "rb") as file:
                for chunk in iter(lambda: file.read(_CHUNK), b""):
                    digest.update(chunk)
        return digest.hexdigest()

    def report_of(self, package, name):
        """Have one package checked, keep its page, and return its report.

        name: the submission's

        Raises CannotCheck; or ClusterError if nothing can be checked any more.
        """
        job = marking.Job(
            class_=self._id,
            checker=marking.checker(),
            contract=self.spec_file.read_bytes(),
            folder=printable(package.root.resolve().name),
            files=marking.packed(package),
            too_large=package.left_out,
            timeout=self.timeout,
        )
        report, page = self._machines.mark(job)
        json_.keep_text(self.results / f"{name}.html", page)
        return report
