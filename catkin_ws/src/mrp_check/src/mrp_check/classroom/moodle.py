# SPDX-License-Identifier: BSD-3-Clause
"""The marks of a class for Moodle: its grading worksheet, with each student's report as feedback.

Moodle takes the columns Identifier, Grade, Last modified (grade), and Feedback comments, which is
HTML: https://github.com/moodle/moodle/blob/main/mod/assign/feedback/offline/importgradeslib.php
"""

from __future__ import annotations

import collections
import csv
import html
import io
import re

from mrp_check.classroom import class_table, mail

_COLUMNS = "Identifier,Full name,Grade,Maximum Grade,Last modified (grade),Feedback comments"
_DOWNLOADED = re.compile(r"([^_]+)_(\d+)_assignsubmission_file(_.*)?", re.DOTALL)


def text(submissions, spec):
    """Return the worksheet: one line for each submission that has a participant's number."""
    file = io.StringIO()
    writer = csv.writer(file)
    writer.writerow(_COLUMNS.split(","))
    for submission, name, number in _numbered(submissions):
        mark, most = f"{submission.mark(spec):g}", f"{class_table.most(spec):g}"
        row = [f"Participant {number}", class_table.cell(name), mark, most, "-"]
        writer.writerow([*row, f"<pre>{html.escape(mail.text(submission, spec))}</pre>"])
    return file.getvalue()


def left_out(submissions):
    """Return the names of the submissions that are not in the worksheet."""
    there = {submission.name for submission, _, _ in _numbered(submissions)}
    return [submission.name for submission in submissions if submission.name not in there]


def _numbered(submissions):
    """Return (submission, student's name, number) of those whose number is in one name alone."""
    found = [(submission, _DOWNLOADED.fullmatch(submission.name)) for submission in submissions]
    named = [(submission, match[1], match[2]) for submission, match in found if match]
    counts = collections.Counter(number for _, _, number in named)
    return [entry for entry in named if counts[entry[2]] == 1]
