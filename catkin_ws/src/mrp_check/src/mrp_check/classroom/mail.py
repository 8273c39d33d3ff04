# SPDX-License-Identifier: BSD-3-Clause
"""A submission's report as a text for a mail, without what the contract hides."""

from __future__ import annotations

from mrp_check.classroom import class_table
from mrp_check.report import html, json_, terminal


def text(one, spec):
    """Return the text for the student of one submission."""
    report = one.shown(spec)
    said = terminal.text(report) if report.requirements else terminal.summary(report)
    mark = f"{one.name}: {class_table.said_of_mark(one, spec)}"
    progress = one.progress(spec, spec.hidden)
    since = [f"Since the earlier hand-in: {progress}"] if progress else []
    return terminal.plain("\n".join([spec.title, mark, *since, report.reason, said])) + "\n"


def write(folder, submissions, spec):
    """Write NAME.txt for each submission, and the page NAME.html anew where it has progress.

    Return a sentence on each file that can't be written.
    """
    failed = []
    for one in submissions:
        texts = {"txt": text(one, spec)}
        if one.before and one.report["requirements"]:
            report = json_.report_of(one.report)
            texts["html"] = html.text(report, progress=one.progress(spec))
        for kind, said in texts.items():
            file = folder / f"{one.name}.{kind}"
            try:
                file.write_text(said, encoding="utf-8", errors="replace")
            except OSError as error:
                failed.append(f"{terminal.plain(str(file))} can't be written: {error.strerror}.")
    return failed
