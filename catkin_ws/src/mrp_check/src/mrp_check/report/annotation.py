# SPDX-License-Identifier: BSD-3-Clause
"""A finding, for somebody who sees the whole repository: its text, and the path of its file."""

from __future__ import annotations

import pathlib

from mrp_check.report import terminal


def base_of(folder: pathlib.Path) -> pathlib.Path:
    """Return the folder to which a reader's paths are relative, for a package's folder.

    It is the root of the package's repository; else the working folder, if the package is in it;
    else the package's own folder.
    """
    above = (folder, *folder.parents)
    repository = next((parent for parent in above if (parent / ".git").exists()), None)
    working = pathlib.Path.cwd()
    return repository or (working if working in above else folder)


def path_of(finding, report):
    """Return the path of a finding's file, below base_of() the report's package."""
    return (report.folder / finding.file).relative_to(base_of(report.folder)).as_posix()


def says_of(finding):
    """Return the lines of a finding, without its place: the message, and what to do."""
    return [finding.message, *terminal.detail_lines(finding, ("expected", "seen", "fix"))]
