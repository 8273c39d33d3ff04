# SPDX-License-Identifier: BSD-3-Clause
"""A whole class at once: `check --class DIR`, where each folder in DIR is one student's.

Each is checked by a process of its own, some at the same time; whatever becomes of one, the others
go on. The report of each is kept beside DIR, in DIR.checked: what has not changed since, nor the
spec nor the checker, is not checked again.
"""

from __future__ import annotations

import concurrent.futures
import csv
import dataclasses
import hashlib
import html
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading

from mrp_check import confine
from mrp_check.confined import cpp_headers
from mrp_check.contract.errors import PackageError
from mrp_check.contract.verdict import BROKEN, MET, UNCHECKED
from mrp_check.rules import REQUIREMENTS
from mrp_check.student.package import Package

JOBS = 2
DEEP = 3  # folders below a student's own in which the package may be
_HERE = pathlib.Path(__file__).resolve().parents[1]
_GRACE = 60  # seconds that a check may take beyond its own limit
_SHOWN = {MET: "met", BROKEN: "broken", UNCHECKED: "unchecked"}


class ClassError(Exception):
    """The class cannot be checked; its text is one sentence."""


@dataclasses.dataclass
class Submission:
    """What came of one student's folder.

    name: of the folder
    report: as in schema/report.json
    kept: whether it is the report of an earlier call
    """

    name: str
    report: dict
    kept: bool = False

    def points(self, spec):
        """Return the points of all requirements that are met."""
        verdicts = self.report["requirements"]
        return sum(points_of(spec, id_) for id_, v in verdicts.items() if v == MET)


def points_of(spec, id_):
    return spec.points.get(id_, 1)


def folders_of(path):
    """Return the students' folders in a class's folder. Raises ClassError."""
    path = pathlib.Path(path)
    if not path.is_dir():
        raise ClassError(f"There is no folder {path}.")
    found = [p for p in sorted(path.iterdir()) if p.is_dir() and not p.name.startswith(".")]
    if not found:
        raise ClassError(f"{path} has no folder in it; expected one for each student.")
    return found


def package_in(folder):
    """Return the folder of the package that a student has handed in. Raises PackageError."""
    if folder.is_symlink() and folder.resolve().parent != folder.parent.resolve():
        raise PackageError(
            f"{folder.name} is a link out of the class's folder: it is not followed."
        )
    look_at, found = [(folder, 0)], []
    while look_at:
        here, depth = look_at.pop(0)
        if (here / "package.xml").is_file():
            found.append(here)
        elif depth < DEEP:
            try:
                with os.scandir(here) as entries:
                    below = sorted(e.name for e in entries if e.is_dir(follow_symlinks=False))
            except OSError:
                continue
            below = [name for name in below if not name.startswith(".")]
            look_at += [(here / name, depth + 1) for name in below[:100]]
        if len(look_at) > 1000:
            break
    if not found:
        raise PackageError(f"{folder.name} has no package.xml: expected the folder of a package.")
    if len(found) > 1:
        names = ", ".join(str(p.relative_to(folder)) for p in found[:4])
        raise PackageError(f"{folder.name} has more than one package: {names}.")
    return found[0]


class Classroom:
    """All submissions of a class.

    folder: in which each sub-folder is a submission
    spec: a spec.Spec; spec_file: where it was read
    jobs: how many are checked at the same time
    timeout: seconds that the check of one may take
    progress: called with a sentence
    results: where the reports are kept
    """

    def __init__(
        self, folder, spec, spec_file, jobs=JOBS, timeout=120, progress=print, results=None
    ):
        self.folders = folders_of(folder)
        self.spec, self.spec_file = spec, pathlib.Path(spec_file).resolve()
        self.jobs, self.timeout, self.progress = jobs, timeout, progress
        name = pathlib.Path(folder).resolve()
        self.results = pathlib.Path(results or name.with_name(name.name + ".checked"))
        self._running, self._done, self._lock = {}, [], threading.Lock()
        self._headers, self._reading = None, threading.Lock()
        self._stopped = False

    def check(self):
        """Check all that must be; return a Submission of each, in the order of their names."""
        self.results.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="mrp_check_class_") as folder:
            self._headers = pathlib.Path(folder) / "ros.pch"
            return self._check_all()

    def _check_all(self):
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = [pool.submit(self._checked, folder) for folder in self.folders]
            try:
                return [future.result() for future in futures]
            except BaseException:
                self._stopped = True
                for future in futures:
                    future.cancel()
                with self._lock:
                    for popen in self._running.values():
                        _kill(popen)
                raise

    def _checked(self, folder):
        try:
            submission = self._submission(folder)
        except Exception as error:  # whatever it is: it is one student's, and the others go on
            submission = Submission(folder.name, _unchecked(f"{type(error).__name__}: {error}"))
        with self._lock:
            self._done.append(submission)
            done, verdict = len(self._done), submission.report["verdict"]
        kept = ", as before" if submission.kept else ""
        self.progress(f"{done} of {len(self.folders)}: {folder.name}: {verdict}{kept}")
        return submission

    def _submission(self, folder):
        try:
            package = Package(package_in(folder))
            fingerprint = self._fingerprint(package)
        except PackageError as error:
            return Submission(folder.name, _unchecked(str(error)))
        file = self.results / f"{folder.name}.json"
        kept = _read(file)
        if kept and kept.get("fingerprint") == fingerprint:
            return Submission(folder.name, kept["report"], kept=True)
        report = self._run(package.root, folder.name)
        if report["verdict"] != UNCHECKED:
            new = file.with_suffix(".new")
            new.write_text(json.dumps({"fingerprint": fingerprint, "report": report}))
            new.rename(file)
        return Submission(folder.name, report)

    def _fingerprint(self, package):
        """Return what is another as soon as anything is that a report depends on."""
        digest = hashlib.sha256(self.spec_file.read_bytes())
        for path in sorted(_HERE.rglob("*.py")):
            digest.update(path.read_bytes())
        for name in package.files:
            path = package.root / name
            data = path.read_bytes()
            mode = path.stat().st_mode & 0o111
            digest.update(f"{name}\0{mode}\0{len(data)}\0".encode(errors="surrogateescape"))
            digest.update(data)
        return digest.hexdigest()

    def _run(self, package, name):
        """Check one package in a process of its own; return its report."""
        with tempfile.TemporaryDirectory(prefix="mrp_check_class_") as scratch:
            os.chmod(scratch, 0o711)  # for the user that the package's programs run as
            try:
                return self._run_in(pathlib.Path(scratch), package, name)
            finally:
                for left in pathlib.Path(scratch).iterdir():
                    if left.is_dir():
                        confine.remove(left)

    def _run_in(self, scratch, package, name):
        report_file = scratch / "report.json"
        page = self.results / f"{name}.html"
        program = "from mrp_check.cli.check import main; main()"
        command = [sys.executable, "-c", program, str(package)]
        command += [f"--spec={self.spec_file}", f"--timeout={self.timeout:g}"]
        command += [f"--json={report_file}", f"--html={page}"]
        with self._reading:  # the first reads them for all
            if not self._headers.exists():
                cpp_headers.make(self._headers)
        env = {**os.environ, "TMPDIR": str(scratch)}
        if self._headers.exists():
            env[cpp_headers.KEPT] = str(self._headers)
        env["PYTHONPATH"] = os.pathsep.join([str(_HERE.parent), env.get("PYTHONPATH", "")])
        with self._lock:
            if self._stopped:
                return _unchecked("The check was stopped.")
            popen = subprocess.Popen(
                command,
                env=env,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
            self._running[name] = popen
        try:
            errors = popen.communicate(timeout=self.timeout + _GRACE)[1]
        except subprocess.TimeoutExpired:
            _kill(popen)
            popen.communicate()
            return _unchecked(f"The check did not end within {self.timeout + _GRACE:.0f} s.")
        finally:
            with self._lock:
                del self._running[name]
        report = _read(report_file)
        if report:
            return report
        said = errors.decode("utf-8", "replace").strip().splitlines()
        return _unchecked(said[-1] if said else f"The check ended with {popen.returncode}.")


def _kill(popen):
    # What it runs confined ends with it: see confine.py.
    try:
        os.killpg(popen.pid, signal.SIGKILL)
    except OSError:
        pass


def _read(file):
    """Return the JSON in a file, or None."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def _unchecked(reason):
    return {
        "verdict": UNCHECKED,
        "package": "",
        "spec": "",
        "requirements": {},
        "findings": [],
        "reason": reason,
    }


# --- The table


def columns():
    """Return the ids of all requirements, by their stages."""
    return list(REQUIREMENTS)


def write_csv(submissions, spec, file):
    """Write one line for each submission: name, verdict, points, each requirement, and why."""
    writer = csv.writer(file)
    writer.writerow(["submission", "package", "verdict", "points", "of", *columns(), "why"])
    for one in submissions:
        verdicts = one.report["requirements"]
        writer.writerow(
            [
                _cell(one.name),
                _cell(one.report["package"]),
                one.report["verdict"],
                f"{one.points(spec):g}",
                f"{most(spec):g}",
                *(verdicts.get(id_, UNCHECKED) for id_ in columns()),
                _cell(why(one)),
            ]
        )


def most(spec):
    return sum(points_of(spec, id_) for id_ in columns())


def why(submission):
    """Return the first causes, in one line."""
    if submission.report.get("reason"):
        return submission.report["reason"]
    return " | ".join(_told(finding) for finding in _causes(submission.report)[:5])


def _causes(report):
    return [f for f in report["findings"] if f["severity"] == "error" and not f["consequence_of"]]


def _told(finding):
    place = f"{finding['file']}:{finding['line']}: " if finding["file"] else ""
    return f"{place}{finding['message']}".replace("\n", " ")


def _cell(text):
    """Return a text that a spreadsheet does not take for a formula."""
    return "'" + text if text[:1] in ("=", "+", "-", "@", "\t") else text


_STYLE = """
:root { color-scheme: light dark; --line: #8886; --met: #2e7d3240; --broken: #c6282850; }
body { font: 16px/1.5 system-ui, sans-serif; margin: 1.5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; }
th, td { border: 1px solid var(--line); padding: .25rem .5rem; text-align: left; }
th, td { vertical-align: top; }
thead th.id { writing-mode: vertical-rl; font-weight: normal; }
td.met { background: var(--met); } td.broken { background: var(--broken); }
td.why { min-width: 24rem; } ul { margin: 0; padding-left: 1rem; }
"""


def write_html(submissions, spec, file, pages):
    """Write one page with a table of all submissions.

    pages: the folder of the submissions' own pages, to which the table links
    """
    text = html.escape
    head = "".join(
        f'<th class="id" title="{text(REQUIREMENTS[id_].title)}">{text(id_)}</th>'
        for id_ in columns()
    )
    rows = []
    for one in submissions:
        verdicts = one.report["requirements"]
        cells = "".join(_html_cell(one, id_, verdicts.get(id_, UNCHECKED)) for id_ in columns())
        page = pathlib.Path(pages) / f"{one.name}.html"
        name = text(one.name)
        if page.is_file() and one.report["requirements"]:
            name = f'<a href="{text(page.resolve().as_uri())}">{name}</a>'
        if one.report.get("reason"):
            reason = text(one.report["reason"])
        else:
            items = "".join(f"<li>{text(_told(f))}</li>" for f in _causes(one.report))
            reason = f"<ul>{items}</ul>" if items else ""
        rows.append(
            f"<tr><th>{name}</th><td>{one.points(spec):g} of {most(spec):g}</td>"
            f"<td>{text(one.report['verdict'])}</td>{cells}<td class='why'>{reason}</td></tr>"
        )
    file.write(
        f"""<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{text(spec.title)}: a class</title><style>{_STYLE}</style></head>
<body>
<h1>{text(spec.title)}: {len(submissions)} submissions</h1>
<div class="wide"><table>
<thead><tr><th>submission</th><th>points</th><th>verdict</th>{head}<th>why</th></tr></thead>
<tbody>
{chr(10).join(rows)}
</tbody>
</table></div>
</body>
</html>
"""
    )


def _html_cell(submission, id_, verdict):
    sign = {MET: "✓", BROKEN: "✗"}.get(verdict, "?")
    told = [
        f["message"]
        for f in submission.report["findings"]
        if f["id"] == id_ and f["severity"] == "error"
    ]
    title = html.escape(" ".join(told) or _SHOWN.get(verdict, verdict))
    return f'<td class="{verdict}" title="{title}">{sign}</td>'


def summary(submissions, spec):
    """Return the table for the console."""
    width = max(len(one.name) for one in submissions)
    lines = []
    for one in submissions:
        broken = [id_ for id_, v in one.report["requirements"].items() if v == BROKEN]
        reason = one.report.get("reason") or ", ".join(broken)
        points = f"{one.points(spec):g}/{most(spec):g}"
        lines.append(
            f"{one.name:{width}}  {one.report['verdict']:9}  {points:>7}  {reason}".rstrip()
        )
    return "\n".join(lines)
