# SPDX-License-Identifier: BSD-3-Clause
"""The report for a reader at a terminal, and what the other reports share with it."""

from __future__ import annotations

import os
import re
import shutil
import textwrap
import time

from mrp_check.contract import resources
from mrp_check.contract.finding import ERROR, NOTE, WARNING, Finding
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
_WIDTH = 100  # characters
_BAR = "|{bar:20}| {n}/{total}, {remaining} left"  # for tqdm

# A package's output and file names must not steer a terminal, and must fit into UTF-8 and XML.
_UNFIT = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


class Progress:
    """Says what is being done: in one line of a terminal, perhaps with a bar, or line by line."""

    def __init__(self, stream):
        self.stream, self.terminal, self.began = stream, stream.isatty(), time.monotonic()

    def show(self, sentence, done=0, of=0):
        """done, of: how many are done of how many, if that is known"""
        if of and self.terminal:
            # Only a class needs it.
            from tqdm import tqdm

            plain_only = "utf" not in (self.stream.encoding or "").lower()
            passed = time.monotonic() - self.began
            bar = tqdm.format_meter(done, of, passed, bar_format=_BAR, ascii=plain_only)
            sentence = f"{bar} {sentence}"
        elif of:
            sentence = f"{done} of {of}: {sentence}"
        start, end = ("\r\x1b[K", "") if self.terminal else ("", "\n")
        line = f"check: {plain(sentence)}"
        if self.terminal:  # the next one overwrites one line
            line = line[: shutil.get_terminal_size().columns - 1]
        print(f"{start}{line}", end=end, file=self.stream, flush=True)

    def clear(self):
        if self.terminal:
            print("\r\x1b[K", end="", file=self.stream, flush=True)


def has_colours(stream):
    """Return whether colours are wanted: on a terminal that is no dumb one, without NO_COLOR."""
    return stream.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"


def text(report, colours=False, everything=False, is_sent=False):
    """Return the whole report: errors, then warnings, then a summary.

    everything: with notes, with what follows from other findings, and with each requirement
    is_sent: without the addresses of pages that are on this machine alone
    """

    def paint(text, colour):
        return f"\x1b[{_COLOURS[colour]}m{text}\x1b[0m" if colours else text

    lines = []
    has_contract = not report.left_out
    for stage, ids in by_stage(report) if has_contract or everything else ():
        lines.append(stage)
        for id_ in ids:
            verdict = report.requirements[id_]
            title = f"{REQUIREMENTS[id_].title} ({id_})"
            lines.append(f"  {paint(MARKS[verdict], verdict)} {title}{why_not(report, id_)}")
    for cause, others, following in causes(report.findings):
        if cause.severity == NOTE and not everything:
            continue
        for finding in (cause, *(following if everything else ())):
            is_short = finding.severity == WARNING and not (has_contract or everything)
            first, *rest = finding_lines(finding, report, is_short, is_sent)
            head, mark, message = first.partition(f" {finding.severity}: ")
            lines += ["", f"{head} {paint(mark.strip(), finding.severity)} {message}", *rest]
        if others:
            places = ", ".join(where(other, report) for other in others)
            lines += _wrapped("  also at:  ", places, " " * 12)
    for finding in report.suppressed:
        lines += ["", *_wrapped("", suppressed_line(finding, report), "  ")]
    if report.left_out and everything:
        left_out = f"Left out, because only a contract can say it: {', '.join(report.left_out)}."
        lines += ["", *_wrapped("", left_out, "")]
    isolation = [plain(report.isolation)] if report.isolation else []
    return "\n".join([*lines, "", *isolation, summary(report)]).lstrip("\n")


def causes(findings):
    """Return (finding, others of the same cause, what follows from it) for each, errors first.

    The same cause is the same requirement, broken in the same way: the same is expected.
    """
    found: dict[tuple, tuple[Finding, list, list]] = {}
    for finding, following in with_consequences(findings):
        what = finding.expected or id(finding)
        key = finding.id, finding.severity, finding.consequence_of, what
        first = found.setdefault(key, (finding, [], []))
        first[2].extend(following)
        if first[0] is not finding:
            first[1].append(finding)
    return list(found.values())


def suppressed_line(finding, report):
    """Return where a finding is that a comment suppresses, what it is of, and why."""
    return f"{where(finding, report)}: suppressed ({finding.id}): {finding.suppressed}"


def by_stage(report):
    """Return (stage, ids of its requirements) for each stage that has any in the report."""
    stages: dict[str, list[str]] = {stage: [] for stage in STAGES}
    for id_ in report.requirements:
        stages[REQUIREMENTS[id_].stage].append(id_)
    return [(stage, ids) for stage, ids in stages.items() if ids]


def why_not(report, id_):
    """Return why nobody can say whether a requirement is met, or an empty text."""
    return f": {report.unseen[id_]}" if id_ in report.unseen else ""


def with_consequences(findings):
    """Return (finding, what follows from it) for each, errors first.

    What follows from a finding that is not there stands by itself, at the end.
    """
    rank = {ERROR: 0, WARNING: 1, NOTE: 2}
    causes = sorted((f for f in findings if not f.consequence_of), key=lambda f: rank[f.severity])
    left, groups = [f for f in findings if f.consequence_of], []
    for cause in causes:
        following = [f for f in left if cause.severity == ERROR and f.consequence_of == cause.id]
        left = [f for f in left if f not in following]
        groups.append((cause, following))
    return groups + [(finding, []) for finding in left]


def where(finding, report):
    """Return FILE:LINE of a finding, as far as it has them; else the package's name."""
    return plain(place(finding.file, finding.line) or report.package)


def place(file, line):
    """Return FILE:LINE without what is None."""
    return ":".join(str(part) for part in (file, line) if part is not None)


def plain(text):
    """Return a text that steers no terminal, and that UTF-8 and XML can hold."""
    return _UNFIT.sub("\ufffd", text)


def finding_lines(finding, report, is_short=False, is_sent=False):
    """Return a finding as lines, without colours.

    is_short: without what another line says, too: what is expected where there is a fix, and the
        page about the requirement where there is one about this very text
    is_sent: as of text()
    """
    lines = _wrapped(f"{where(finding, report)}: {finding.severity}: ", finding.message, "  ")
    has_fix = is_short and finding.fix
    lines += detail_lines(finding, ("seen", "fix") if has_fix else ("expected", "seen", "fix"))
    cause = finding.consequence_of
    if cause:
        return [*lines, f"  This follows from: {REQUIREMENTS[cause].title} ({cause})"]
    links = pages(finding)[-1:] if is_short else pages(finding)
    shown = [f"  {name + ':':<10}{address_of(page)}" for name, page in links]
    return lines + [line for line in shown if not is_sent or "file://" not in line]


def pages(finding):
    """Return (name, address) of the places of the pages that explain a finding."""
    found = [("page", REQUIREMENTS[finding.id].page)]
    return [*found, ("why", f"pages/why.html#{finding.why}")] if finding.why else found


def address_of(page):
    """Return the address of a page of the tutorial; or its name, if nobody knows an address."""
    if address := resources.address_of(page):
        return address
    path, _, anchor = page.partition("#")
    name = path.rpartition("/")[2].partition(".")[0].replace("_", " ")
    return f"“{name}” of the tutorial" + (f", {anchor}" if anchor else "")


def detail_lines(finding, names):
    """Return those of the named fields of a finding that say something, as lines."""
    lines = []
    for name in names:
        value = plain(getattr(finding, name))
        head = f"  {name + ':':<10}"
        if "\n" in value:
            lines += [head.rstrip(), *("    " + line for line in value.split("\n"))]
        elif value:
            lines += _wrapped(head, value, " " * len(head))
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
    """Return one sentence: how many requirements are met, and how many are not; or, without a
    contract, how many findings there are."""
    if not report.requirements:
        return "Nothing could be checked."
    verdicts = list(report.requirements.values())
    causes_ = [finding for finding in report.findings if not finding.consequence_of]
    warnings = sum(cause.severity == WARNING for cause in causes_)
    suppressed = f"; suppressed: {len(report.suppressed)}" if report.suppressed else ""
    if report.left_out:
        errors = sum(cause.severity == ERROR for cause in causes_)
        notes = len(report.findings) - errors - warnings
        rest = f" ({notes} more with --all; with make: ALL=1)" if notes else ""
        return f"Errors: {errors}; warnings: {warnings}{suppressed}{rest}."
    kind = "public requirements" if report.is_public else "requirements"
    met, broken = verdicts.count(MET), verdicts.count(BROKEN)
    unchecked = verdicts.count(UNCHECKED)
    rest = f"; {unchecked} couldn't be checked" if unchecked else ""
    rest += (f"; warnings: {warnings}" if warnings else "") + suppressed
    if broken or unchecked:
        return f"{broken} of {len(verdicts)} {kind} are not met{rest}."
    return f"All {kind} are met: {met} of {len(verdicts)}{rest}."
