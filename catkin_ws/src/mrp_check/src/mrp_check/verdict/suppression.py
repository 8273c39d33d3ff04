# SPDX-License-Identifier: BSD-3-Clause
"""A comment that suppresses a finding, and says why: `# mrp_check: ignore spin: it has a loop`.

Only where no contract gives points: else a student could suppress all that a package lacks.
"""

from __future__ import annotations

import re
from typing import Collection, Iterator, NamedTuple

from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.schema import near
from mrp_check.package.package import Package
from mrp_check.rules import REQUIREMENTS

_BEGINS = {"cpp": "//", "header": "//", "launch": "<!--"}
_BEGINS.update(dict.fromkeys(("python", "cmake", "message", "service", "action"), "#"))
_COMMENT = r"%s\s*mrp_check:\s*ignore\b\s*([\w-]*)\s*:?\s*(.*?)\s*(?:-->.*)?$"
_FORM = "mrp_check: ignore ID: the reason"


class Comment(NamedTuple):
    """It is about its own line and the next one."""

    file: str
    line: int
    id: str
    reason: str

    def suppresses(self, finding: Finding) -> bool:
        is_there = finding.file == self.file and finding.line in (self.line, self.line + 1)
        return is_there and self.id == finding.id and bool(self.reason)


def comments(package: Package) -> Iterator[Comment]:
    for file in package.files:
        begins = "<!--" if file.endswith(".xml") else _BEGINS.get(package.kind(file))
        if begins and b"mrp_check:" in package.bytes(file):
            for number, line in enumerate(package.lines(file), 1):
                found = re.search(_COMMENT % begins, line)
                if found:
                    yield Comment(file, number, *found.groups())


def applied(
    package: Package, findings: list[Finding], checked: Collection[str], has_contract: bool
) -> tuple[list[Finding], list[Finding]]:
    """Return the findings that stay, and those that comments suppress.

    Those that stay have with them what is wrong with the comments.

    checked: the ids of the requirements that could be checked
    """
    written = [*comments(package)]
    heeded = [] if has_contract else written
    suppressed = []
    for finding in findings:
        comment = next((comment for comment in heeded if comment.suppresses(finding)), None)
        if comment:
            finding.suppressed = comment.reason
            suppressed.append(finding)
    stay = [finding for finding in findings if not finding.suppressed]
    # What follows from a suppressed finding was seen all the same, and nobody has named it.
    gone = {finding.id for finding in suppressed} - {finding.id for finding in stay}
    for finding in stay:
        if finding.consequence_of in gone:
            finding.consequence_of = None
    for entry in written:
        idle = entry.id in checked and not any(entry.suppresses(finding) for finding in suppressed)
        stay += _wrong(entry, idle, has_contract)
    return stay, suppressed


def _wrong(comment: Comment, idle: bool, has_contract: bool) -> Iterator[Finding]:
    """Yield what is wrong with a comment, under the requirement that it names.

    idle: whether it suppresses nothing, and its requirement was checked
    """
    place = comment.file, comment.line
    if comment.id not in REQUIREMENTS:
        message = f"A comment suppresses '{comment.id}': there's no such requirement."
        message += near(comment.id, REQUIREMENTS)
        yield Finding("text", message, *place, HABIT, expected=_FORM)
    elif has_contract:
        message = f"This comment suppresses nothing of {comment.id}: a contract says what counts."
        yield Finding(comment.id, message, *place, HINT)
    elif not comment.reason:
        message = f"A comment suppresses {comment.id}, but gives no reason: it does nothing."
        yield Finding(comment.id, message, *place, HABIT, expected=_FORM)
    elif idle:
        message = f"A comment suppresses {comment.id}, but there's no such finding here."
        fix = "Remove the comment, or write it on the line of the finding or the line above."
        yield Finding(comment.id, message, *place, HABIT, fix=fix)
