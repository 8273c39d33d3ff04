# SPDX-License-Identifier: BSD-3-Clause
"""The marks of a class for Moodle: its grading worksheet, and a page for each student.

Moodle takes the columns Identifier, Grade, Last modified (grade), and Feedback comments, which is
HTML, and finds the student of a feedback file by the number in its folder's name:
https://github.com/moodle/moodle/blob/main/mod/assign/feedback/offline/importgradeslib.php
https://github.com/moodle/moodle/blob/main/mod/assign/feedback/file/importziplib.php
"""

from __future__ import annotations

import collections
import csv
import html
import io
import re
import zipfile

from mrp_check.classroom import class_table
from mrp_check.contract.finding import ERROR
from mrp_check.report import html as page
from mrp_check.report import terminal

_COLUMNS = "Identifier,Full name,Grade,Maximum Grade,Last modified (grade),Feedback comments"
_DOWNLOADED = re.compile(r"([^_]+)_(\d+)_assignsubmission_file(_.*)?", re.DOTALL)


def text(submissions, spec):
    """Return the worksheet: one line for each submission that has a participant's number."""
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerow(_COLUMNS.split(","))
    for one, name, number in _numbered(submissions):
        mark, most = f"{one.mark(spec):g}", f"{class_table.most(spec):g}"
        row = [f"Participant {number}", class_table.cell(name), mark, most, "-"]
        writer.writerow([*row, _comment(one, spec)])
    return file.getvalue()


def write_pages(path, submissions, spec):
    """Write the zip of feedback files, without what the spec hides and links to this machine."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for one, name, number in _numbered(submissions):
            folder = f"{name}_{number}_assignsubmission_file_"
            report = page.text(one.shown(spec), has_links=False)
            archive.writestr(f"{folder}/feedback.html", report)


def left_out(submissions):
    """Return the names of the submissions that are neither in the worksheet nor in the zip."""
    there = {one.name for one, _, _ in _numbered(submissions)}
    return [submission.name for submission in submissions if submission.name not in there]


def _numbered(submissions):
    """Return (submission, student's name, number) of those whose number is in one name alone."""
    found = [(submission, _DOWNLOADED.fullmatch(submission.name)) for submission in submissions]
    named = [(one, match[1], match[2]) for one, match in found if match]
    counts = collections.Counter(number for _, _, number in named)
    return [entry for entry in named if counts[entry[2]] == 1]


def _comment(one, spec):
    """Return the HTML of what a person has set, and of what is wrong, a line for each cause."""
    report = one.shown(spec)
    causes = [f for f in report.findings if f.severity == ERROR and not f.consequence_of]
    said = [f"{terminal.where(f, report)}: {f.message}" for f in causes]
    by_hand = class_table.said_of_mark(one, spec) if str(one.by_hand) else ""
    lines = filter(
        None, [terminal.summary(report), report.reason, by_hand, *said, report.isolation]
    )
    return "<br>".join(html.escape(terminal.plain(line)) for line in lines)
