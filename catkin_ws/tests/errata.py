# SPDX-License-Identifier: BSD-3-Clause
"""What the original page prints, as a package, and what mends it so far that its nodes start."""

import pathlib
import subprocess

ERRATA = pathlib.Path(__file__).parent / "errata"
ORIGINAL = ERRATA / "original"
PACKAGE = "my_robotics_pkg"

# The mends without which its nodes do not start.
STARTS = ("e01_global", "e03_parenthesis", "e12_interpreter")


def mend(package, *names):
    """Apply patches of errata/mends to a copy of the original."""
    for name in names:
        command = ["patch", "-p1", "--fuzz=0", f"--input={ERRATA / 'mends' / name}.patch"]
        subprocess.run(command, cwd=package, check=True)


def replace(path, old, new):
    """Replace the one place in a file that has the text `old`."""
    text = path.read_text()
    assert text.count(old) == 1, f"{old!r} in {path}"
    path.write_text(text.replace(old, new))


def line_of(path, text):
    """Return the one line of a file that has the text."""
    (line,) = [line for line in path.read_text().splitlines() if text in line]
    return line.strip()
