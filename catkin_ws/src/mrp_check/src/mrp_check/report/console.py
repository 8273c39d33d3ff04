# SPDX-License-Identifier: BSD-3-Clause
"""The report for a reader at a terminal."""

from __future__ import annotations

import os
import re
import textwrap

from mrp_check.contract.finding import ERROR, NOTE, WARNING
from mrp_check.contract.requirements import STAGES
from mrp_check.contract.verdict import BROKEN, MET, UNCHECKED
from mrp_check.rules import REQUIREMENTS

MARKS = {MET: "[OK]  ", BROKEN: "[FAIL]", UNCHECKED: "[--]  "}
_COLOURS = {
    MET: "32",
    BROKEN: "31",
    UNCHECKED: "33",
    ERROR: "31",
    WARNING: "33",
    NOTE: "36",
}
_WIDTH = 100

# What a package prints or has in its files must not steer the terminal of whoever checks it.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


class Progress:
    """Says what is being done: in one line of a terminal, or line by line."""

    def __init__(self, stream):
        self.stream = stream
        self.terminal = stream.isatty()

    def show(self, sentence):
        end = "" if self.terminal else "\n"
        start = "\r\x1b[K" if self.terminal else ""
        print(f"{start}check: {sentence}", end=end, file=self.stream, flush=True)

    def clear(self):
        if self.terminal:
            print("\r\x1b[K", end="", file=self.stream, flush=True)


def has_colours(stream):
    """Return whether colours are wanted: on a terminal that is no dumb one, without NO_COLOR."""
    return stream.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"


def text(report, colours=False):
    """Return the whole report: each requirement's verdict, then the findings, then a summary."""

    def paint(text, colour):
        return f"\x1b[{_COLOURS[colour]}m{text}\x1b[0m" if colours else text

    lines = []
    for stage in STAGES:
        ids = [id_ for id_ in report.requirements if REQUIREMENTS[id_].stage == stage]
        if ids:
            lines.append(stage)
        for id_ in ids:
            verdict = report.requirements[id_]
            title = f"{REQUIREMENTS[id_].title} ({id_})"
            lines.append(f"  {paint(MARKS[verdict], verdict)} {title}{why_not(report, id_)}")
    for finding in in_order(report.findings):
        first, *rest = finding_lines(finding, report)
        head, _, message = first.partition(f" {finding.severity}: ")
        lines += ["", f"{head} {paint(finding.severity + ':', finding.severity)} {message}", *rest]
    return "\n".join([*lines, "", summary(report)])


def why_not(report, id_):
    """Return why nobody can say whether a requirement is met, or an empty text."""
    return f": {report.unseen[id_]}" if id_ in report.unseen else ""


def in_order(findings):
    """Return the findings with each consequence after its cause, errors first."""
    rank = {ERROR: 0, WARNING: 1, NOTE: 2}
    causes = sorted((f for f in findings if not f.consequence_of), key=lambda f: rank[f.severity])
    left, ordered = [f for f in findings if f.consequence_of], []
    for cause in causes:
        ordered.append(cause)
        if cause.severity == ERROR:
            ordered += [f for f in left if f.consequence_of == cause.id]
            left = [f for f in left if f.consequence_of != cause.id]
    return ordered + left


def where(finding, report):
    """Return FILE:LINE of a finding, as far as it has them; else the package's name."""
    parts = [str(part) for part in (finding.file, finding.line) if part is not None]
    return plain(":".join(parts) or report.package)


def plain(text):
    """Return a text in which nothing steers a terminal."""
    return _CONTROL.sub("\ufffd", text)


def finding_lines(finding, report):
    """Return a finding as lines, without colours."""
    lines = _wrapped(f"{where(finding, report)}: {finding.severity}: ", finding.message, "  ")
    for name in ("expected", "seen", "fix"):
        value = plain(getattr(finding, name))
        if not value:
            continue
        head = f"  {name + ':':<10}"
        if "\n" in value:
            lines.append(head.rstrip())
            lines += ["    " + line for line in value.split("\n")]
        else:
            lines += _wrapped(head, value, " " * len(head))
    if finding.consequence_of:
        lines.append(
            f"  This follows from: {REQUIREMENTS[finding.consequence_of].title}"
            f" ({finding.consequence_of})"
        )
    else:
        lines.append(f"  page:     {REQUIREMENTS[finding.id].page}")
    return lines


def _wrapped(head, text, indent):
    return textwrap.wrap(
        head + plain(text),
        _WIDTH,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
        drop_whitespace=True,
    )


def summary(report):
    """Return one sentence: how many requirements are met, and how many are not."""
    if not report.requirements:
        return "Nothing could be checked."
    verdicts = list(report.requirements.values())
    met, broken = verdicts.count(MET), verdicts.count(BROKEN)
    unchecked = verdicts.count(UNCHECKED)
    rest = f"; {unchecked} could not be checked" if unchecked else ""
    warnings = sum(f.severity == WARNING and not f.consequence_of for f in report.findings)
    rest += f"; warnings: {warnings}" if warnings else ""
    if broken or unchecked:
        return f"{broken} of {len(verdicts)} requirements are not met{rest}."
    return f"All requirements are met: {met} of {len(verdicts)}{rest}."
