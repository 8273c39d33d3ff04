# SPDX-License-Identifier: BSD-3-Clause
"""The check of one submission of a class, in a process of its own, on whichever machine that is.

A Job has all that it needs, and mark() returns all that comes of it: no folder is shared.
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import io
import os
import pathlib
import signal
import subprocess
import sys
import tarfile
import threading

from mrp_check.contract import resources
from mrp_check.contract.errors import CannotCheck
from mrp_check.package.package import MAX_BYTES, Package, is_of_tools
from mrp_check.report import json_
from mrp_check.sandbox.scratch import scratch_folder

_HERE = pathlib.Path(__file__).resolve().parents[1]
_GRACE = 60  # seconds that a check may take beyond its own limit
_PROGRAM = "from mrp_check.cli.check import main; main()"

_LOCK = threading.Lock()
_RUNNING: dict[subprocess.Popen, str] = {}  # the checks, and their classes
_STOPPED: set[str] = set()  # classes


@dataclasses.dataclass(frozen=True)
class Job:
    """What is checked.

    class_: names the class, for stop()
    checker: the digest of the checker that is to check it
    contract: the text of the spec
    folder: what the package's folder is called
    files: the package, packed
    too_large: files of the package that are not looked at
    timeout: seconds that it may take
    """

    class_: str
    checker: str
    contract: bytes = dataclasses.field(repr=False)  # a cluster's log has the rest
    folder: str
    files: bytes = dataclasses.field(repr=False)
    too_large: list[str]
    timeout: float


def packed(package: Package) -> bytes:
    """Return a package's files and folders as a tar."""

    def without_owner(info):
        for name, nobody in (("uid", 0), ("gid", 0), ("uname", ""), ("gname", "")):
            setattr(info, name, nobody)
        return info

    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w:gz", compresslevel=1, dereference=True) as tar:
        for folder, folders, _ in os.walk(package.root):
            folders[:] = [name for name in folders if not is_of_tools(name)]
            name = os.path.relpath(folder, package.root)
            tar.add(folder, name, recursive=False, filter=without_owner)
        for name in (*package.files, *package.not_utf8):
            tar.add(package.root / name, name, recursive=False, filter=without_owner)
    return file.getvalue()


@functools.lru_cache(maxsize=None)
def checker() -> str:
    """Return a text that is another one in each version of the checker."""
    digest = hashlib.sha256()
    templates = resources.folder("templates")
    for path in [*sorted(_HERE.rglob("*.py")), *sorted(templates.iterdir())]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def mark(job: Job) -> tuple[dict, str]:
    """Check one submission; return its report, and the same as a page. Raises CannotCheck."""
    with scratch_folder() as scratch:
        package = scratch / "package" / job.folder
        with tarfile.open(fileobj=io.BytesIO(job.files)) as tar:
            tar.extractall(package)
        for name in job.too_large:
            (package / name).touch()
            os.truncate(package / name, MAX_BYTES + 1)
        contract, report, page = (scratch / name for name in ("spec.yaml", "r.json", "r.html"))
        contract.write_bytes(job.contract)
        command = [sys.executable, "-c", _PROGRAM, str(package), f"--spec={contract}"]
        command += [f"--timeout={job.timeout:g}", f"--json={report}", f"--html={page}"]
        env = {**os.environ, "TMPDIR": str(scratch)}
        env["PYTHONPATH"] = os.pathsep.join([str(_HERE.parent), env.get("PYTHONPATH", "")])
        # There, all checks share ROS's headers as clang has read them: see cpp_headers.py.
        home = os.path.expanduser("~")
        if os.path.isabs(home):
            env.setdefault("XDG_CACHE_HOME", os.path.join(home, ".cache"))
        code, lines = _run(job, command, env)
        found = json_.kept(report)
        if not found:
            raise CannotCheck(lines[-1] if lines else f"The check ended with {code}.")
        return found, page.read_text(encoding="utf-8")


def stop(class_: str) -> None:
    """End the checks of a class that run here; none of it begins any more."""
    with _LOCK:
        _STOPPED.add(class_)
        for popen in [popen for popen, of in _RUNNING.items() if of == class_]:
            _kill(popen)


def _run(job, command, env):
    """Run a command; return its exit code and the lines of its stderr. Raises CannotCheck."""
    with _LOCK:
        if job.class_ in _STOPPED:
            raise CannotCheck("The check was stopped.")
        popen = subprocess.Popen(
            # If this process is killed, the check is to end as with Ctrl-C.
            ["setpriv", "--pdeathsig", "TERM", *command],
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
        _RUNNING[popen] = job.class_
    limit = job.timeout + _GRACE
    try:
        stderr = popen.communicate(timeout=limit)[1]
    except subprocess.TimeoutExpired:
        _kill(popen)
        popen.communicate()
        raise CannotCheck(f"The check didn't end within {limit:.0f} s.") from None
    finally:
        with _LOCK:
            del _RUNNING[popen]
    return popen.returncode, stderr.strip().splitlines()


def _kill(popen):
    # What it runs confined ends with it: see confine.py.
    try:
        os.killpg(popen.pid, signal.SIGKILL)
    except OSError:
        pass
