# SPDX-License-Identifier: BSD-3-Clause
"""The report as annotations, by the workflow commands of GitHub Actions.

Their form and their escapes are those of `command.ts` in GitHub's own package @actions/core.
"""

from __future__ import annotations

import secrets

from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.report import terminal
from mrp_check.report.annotation import path_of, says_of

_COMMANDS = {ERROR: "error", WARNING: "warning"}
_OF_MESSAGE = {"%": "%25", "\r": "%0D", "\n": "%0A"}
_OF_PROPERTY = {**_OF_MESSAGE, ":": "%3A", ",": "%2C"}


def text(report):
    """Return a line for each finding that follows from no other; the notes are left out."""
    lines = []
    for finding in report.findings:
        if finding.consequence_of or finding.severity == NOTE:
            continue
        place = {"title": f"mrp_check: {finding.id}"}
        if finding.file:
            line = {"line": str(finding.line)} if finding.line else {}
            place = {"file": path_of(finding, report), **line, **place}
        lines.append(_command(_COMMANDS[finding.severity], place, "\n".join(says_of(finding))))
    if report.reason:
        lines.append(_command("error", {"title": "mrp_check"}, report.reason))
    if report.isolation:
        lines.append(_command("notice", {"title": "mrp_check"}, report.isolation))
    return "\n".join(lines)


def _command(name, properties, message):
    written = ",".join(f"{key}={_escaped(item, _OF_PROPERTY)}" for key, item in properties.items())
    return f"::{name} {written}::{_escaped(message, _OF_MESSAGE)}"


def _escaped(text, escapes):
    return terminal.plain(text).translate(str.maketrans(escapes))


def stopped(text):
    """Return a text in which GitHub takes nothing for a command: a package may print one."""
    token = secrets.token_hex(16)
    return f"::stop-commands::{token}\n{text}\n::{token}::"
