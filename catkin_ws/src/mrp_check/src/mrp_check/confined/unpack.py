# SPDX-License-Identifier: BSD-3-Clause
"""Unpacks what a student packed. Runs confined: it may mean harm.

Usage: unpack.py ARCHIVE FOLDER    (which is there, and empty)

CMake's tar reads what libarchive does: zip, 7-Zip, tar, also compressed. git reads a bundle.
"""

import os
import re
import signal
import subprocess
import sys
import zipfile

# Which commit: of a bundle without HEAD, the latest one.
_GIT = """git clone --quiet --bare "$0" "$0_clone" && cd "$0_clone" &&
commit=$(git rev-parse --quiet --verify HEAD ||
  git for-each-ref --count=1 --sort=-committerdate --format="%(objectname)") &&
git archive "$commit" | tar --extract --directory "$OLDPWD"
"""
_BUNDLE = re.compile(rb"# v[23] git bundle")
_LEADS_OUT = re.compile(r"/|[A-Za-z]:[/\\]|(.*[/\\])?\.\.([/\\]|$)")
_OF_UNIX = 3  # in a zip, the system that wrote an entry


def main() -> None:
    archive, folder = sys.argv[1:]
    os.chdir(folder)
    with open(archive, "rb") as file:
        head = file.read(20)
    if not head:
        sys.exit("it is an empty file")
    if _BUNDLE.match(head):
        _run("bash", "-o", "pipefail", "-c", _GIT, archive)
        return
    for name in _run("cmake", "-E", "tar", "tf", archive).splitlines():
        if _LEADS_OUT.match(name):
            sys.exit(f"its entry {name} leads out of it")
    _run("cmake", "-E", "tar", "xf", archive)
    if zipfile.is_zipfile(archive) and not _has_modes(archive):
        _make_scripts_executable()


def _run(*command: str) -> str:
    """Run a command; return what it prints, or exit with what it says is wrong."""
    done = subprocess.run(command, capture_output=True)
    if done.returncode == -signal.SIGXFSZ:
        sys.exit("it unpacks to a file that is far too large")
    stderr = done.stderr.decode("utf-8", "replace").strip()
    # If CMake can't read one entry, it prints an error and still exits with 0.
    if done.returncode or "error:" in stderr:
        first = (stderr or f"exit code {done.returncode}").splitlines()[0]
        sys.exit(re.sub(r"^cmake -E tar: |^CMake Error: Problem with \w+\(\): ", "", first))
    return done.stdout.decode("utf-8", "replace")


def _has_modes(archive: str) -> bool:
    """Return whether a zip knows what is executable: Windows doesn't, and git, which writes its
    commit as the comment, gives modes only to what is."""
    with zipfile.ZipFile(archive) as file:
        is_of_git = re.fullmatch(rb"[0-9a-f]{40}", file.comment)
        return bool(is_of_git) or any(entry.create_system == _OF_UNIX for entry in file.infolist())


def _make_scripts_executable() -> None:
    for folder, _, names in os.walk("."):
        for path in (os.path.join(folder, name) for name in names):
            if os.path.isfile(path) and not os.path.islink(path):
                with open(path, "rb") as file:
                    if file.read(2) == b"#!":
                        os.chmod(path, 0o755)


if __name__ == "__main__":
    main()
