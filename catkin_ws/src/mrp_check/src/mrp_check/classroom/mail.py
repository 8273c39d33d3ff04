# SPDX-License-Identifier: BSD-3-Clause
"""A submission's report as a text for a mail, without what the contract hides."""

from __future__ import annotations

from mrp_check.classroom import class_table
from mrp_check.report import terminal


def text(submission, spec):
    """Return the text for the student of one submission."""
    report = submission.shown(spec)
    summary = terminal.summary(report)
    body = terminal.text(report, is_sent=True) if report.requirements else summary
    mark = f"{submission.name}: {class_table.said_of_mark(submission, spec)}"
    return terminal.plain("\n".join([spec.title, mark, report.reason, body])) + "\n"


def write(folder, submissions, spec):
    """Write NAME.txt for each submission; return a sentence on each that can't be written."""
    failed = []
    for submission in submissions:
        file = folder / f"{submission.name}.txt"
        try:
            file.write_text(text(submission, spec), encoding="utf-8", errors="replace")
        except OSError as error:
            failed.append(f"{terminal.plain(str(file))} can't be written: {error.strerror}.")
    return failed
