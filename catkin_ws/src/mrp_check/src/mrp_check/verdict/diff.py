# SPDX-License-Identifier: BSD-3-Clause
"""A fix as a diff, where it is certain."""

from __future__ import annotations

import difflib


def add(package, finding):
    """Add the diff of its change to a finding's fix; drop a change that is not certain."""
    patch = ""
    if finding.change and finding.file and finding.line:
        patch = of_change(package, finding.file, finding.line, finding.change)
    if patch:
        finding.fix = "\n".join(part for part in (finding.fix, patch) if part)
    else:
        finding.change = None


def of_change(package, file, line, change):
    """Return the unified diff, as `patch -p1` takes it, of a change in one line of a file.

    change: (old, new)

    Returns "" if the line has not `old` exactly once, as the fix is not certain then; or if the
    file is no plain UTF-8 whose lines all end with a newline, as the diff would not fit.
    """
    old, new = change
    text = package.text(file)
    lines = text.split("\n")
    plain = text.encode() == package.bytes(file) and not lines[-1]
    if not plain or lines[line - 1].count(old) != 1:
        return ""
    changed = [*lines[: line - 1], *lines[line - 1].replace(old, new).split("\n"), *lines[line:]]
    diff = difflib.unified_diff(lines[:-1], changed[:-1], f"a/{file}", f"b/{file}", lineterm="")
    return "\n".join(diff)
