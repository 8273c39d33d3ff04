# SPDX-License-Identifier: BSD-3-Clause
"""The reports of a whole class as one table: for the console, as CSV and as a page."""

from __future__ import annotations

import csv
import dataclasses
import io
import pathlib

from mrp_check.classroom.by_hand import ByHand
from mrp_check.contract.finding import ERROR
from mrp_check.contract.verdict import BROKEN, MET, UNCHECKED, public
from mrp_check.report import html, json_, terminal
from mrp_check.rules import OF_CONTRACT

_MOST_CAUSES = 5  # in one line of the CSV
_SIGNS = {MET: "✓", BROKEN: "✗", UNCHECKED: "?"}


@dataclasses.dataclass
class Submission:
    """The result of what one student has handed in.

    name: of the folder or the file
    report: as in schema/report.json
    kept: whether it is the report of an earlier call
    depends_on: what the report depends on -> a text that changes with it
    by_hand: what a person has set, or None
    """

    name: str
    report: dict
    kept: bool = False
    depends_on: dict = dataclasses.field(default_factory=dict)
    by_hand: ByHand | None = None

    def verdict_on(self, id_):
        """Return the verdict on one requirement: MET, BROKEN or UNCHECKED."""
        return self.report["requirements"].get(id_, UNCHECKED)

    def points(self, spec):
        """Return the points of all requirements that are met."""
        return sum(spec.points_of(id_) for id_ in OF_CONTRACT if self.verdict_on(id_) == MET)

    def mark(self, spec):
        """Return the points that a person has set, or else the measured ones."""
        return self.by_hand.points if self.by_hand else self.points(spec)

    def shown(self, spec):
        """Return what the student may see of the Report."""
        return public(json_.report_of(self.report), spec.hidden)

    def errors(self):
        return [f for f in self.report["findings"] if f["severity"] == ERROR]

    def causes(self):
        """Return the reason why it could not be checked; or each error, on one line."""
        if self.report.get("reason"):
            return [self.report["reason"]]
        return [_one_line(f) for f in self.errors() if not f["consequence_of"]]


def asked_by(spec):
    """Return the ids of the requirements that a contract asks for, in their order."""
    return [id_ for id_ in OF_CONTRACT if spec.asks(id_)]


def most(spec):
    """Return the points of a package that meets all requirements."""
    return sum(map(spec.points_of, OF_CONTRACT))


def _one_line(finding):
    place = terminal.place(finding["file"], finding["line"])
    return ": ".join(part for part in (place, finding["message"]) if part).replace("\n", " ")


def csv_text(submissions, spec):
    """Return one line for each submission: name, verdict, points, mark, and each requirement."""
    file = io.StringIO()
    writer = csv.writer(file)
    asked = asked_by(spec)
    columns = "submission package verdict points of by_hand mark".split()
    writer.writerow([*columns, *asked, "why", "isolation"])
    for submission in submissions:
        writer.writerow(
            [
                cell(submission.name),
                cell(submission.report["package"]),
                submission.report["verdict"],
                f"{submission.points(spec):g}",
                f"{most(spec):g}",
                cell(str(submission.by_hand or "")),
                f"{submission.mark(spec):g}",
                *map(submission.verdict_on, asked),
                cell(" | ".join(submission.causes()[:_MOST_CAUSES])),
                cell(submission.report.get("isolation", "")),
            ]
        )
    return file.getvalue()


def cell(text):
    """Return a text that steers no terminal, and that a spreadsheet does not take for a formula."""
    return "'" * text.startswith(("=", "+", "-", "@", "\t")) + terminal.plain(text)


def broken_in(submissions):
    """Return (id, names of the submissions) for each requirement that is not met, most first."""
    found = [
        (
            id_,
            [submission.name for submission in submissions if submission.verdict_on(id_) == BROKEN],
        )
        for id_ in OF_CONTRACT
    ]
    return sorted([entry for entry in found if entry[1]], key=lambda entry: -len(entry[1]))


def html_text(submissions, spec, pages):
    """Return one page with a table of all submissions.

    pages: the folder of the submissions' own pages; the table links to them
    """

    def page_of(submission):
        page = pathlib.Path(pages) / f"{submission.name}.html"
        return (
            page.resolve().as_uri() if submission.report["requirements"] and page.is_file() else ""
        )

    return html.render(
        "class.html",
        asked=asked_by(spec),
        signs=_SIGNS,
        submissions=submissions,
        spec=spec,
        most=most(spec),
        page_of=page_of,
        broken=broken_in(submissions),
        address_of=html.address_of,
        has_marks=any(submission.by_hand for submission in submissions),
        isolations=isolations(submissions),
    )


def text(submissions, spec):
    """Return the table for the console."""
    width = max(len(submission.name) for submission in submissions)
    lines = []
    for submission in submissions:
        broken = [id_ for id_ in OF_CONTRACT if submission.verdict_on(id_) == BROKEN]
        reason = submission.report.get("reason") or ", ".join(broken)
        points = f"{submission.points(spec):g}/{most(spec):g}"
        verdict = submission.report["verdict"]
        lines.append(f"{submission.name:{width}}  {verdict:9}  {points:>7}  {reason}".rstrip())
    lines += [
        f"{submission.name}: {said_of_mark(submission, spec)}"
        for submission in submissions
        if submission.by_hand
    ]
    return terminal.plain("\n".join([*lines, *isolations(submissions)]))


def isolations(submissions):
    """Return how far the packages were kept apart as they ran: most often one sentence for all."""
    return sorted(
        {
            submission.report["isolation"]
            for submission in submissions
            if "isolation" in submission.report
        }
    )


def said_of_mark(submission, spec):
    """Return a submission's mark, and what a person has set."""
    mark = f"mark {submission.mark(spec):g} of {most(spec):g}"
    return f"{mark}, by hand: {submission.by_hand}" if submission.by_hand else mark
