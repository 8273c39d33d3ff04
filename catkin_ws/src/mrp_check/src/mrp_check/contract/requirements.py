# SPDX-License-Identifier: BSD-3-Clause
"""What a rule and a requirement are. The rules themselves are the files of rules/."""

from __future__ import annotations

import typing
from typing import Any, Callable, Iterable, Iterator, Mapping

from mrp_check.contract.finding import CERTAIN, READ, SEEN, Finding

STAGES = ("files", "static", "build", "run", "stop")
STATIC = STAGES[:2]  # nothing is built or run
CONTRACT, ANY = "contract", "any"
# How sure a rule of a stage is, unless it says otherwise.
_SURE = {"files": CERTAIN, "static": READ, "build": SEEN, "run": SEEN, "stop": SEEN}


class Requirement(typing.NamedTuple):
    """What a package must meet.

    title: a sentence that is true of a package which meets it
    section: page of the tutorial, and the anchor on it
    why_unseen: called with a case.Case; says why nobody can know whether it is met, or returns None
    stage: in whose group it is shown: that of its rule
    """

    title: str
    section: str
    why_unseen: Callable[..., str | None]
    stage: str = ""

    @property
    def page(self) -> str:
        """Where it is explained: a file of the built pages, and the place in it."""
        page, _, anchor = self.section.partition("#")
        return f"pages/{page}.html" + (f"#{anchor}" if anchor else "")


class Rule(typing.NamedTuple):
    """A rule, which can find requirements not met.

    stage: when it is asked
    needs: what it looks at, names in NEEDS
    findings: called with a case.Case, yields a Finding for each thing that is wrong
    requirements: id -> Requirement, of those that it stands for
    also: ids of other rules' requirements that it can report, too
    sure: the certainty of findings that don't give one, if it isn't that of the stage
    begins: called with a case.Case before the first stage: starts a tool, which runs meanwhile
    only: CONTRACT if it compares with what a contract says, ANY if it is for packages without one
    """

    stage: str
    needs: tuple[str, ...]
    findings: Callable[..., Iterable[Finding]]
    requirements: Mapping[str, Requirement] = {}
    also: tuple[str, ...] = ()
    only: str = ""
    sure: str = ""
    begins: Callable[..., object] | None = None

    @property
    def ids(self) -> tuple[str, ...]:
        return (*self.requirements, *self.also)

    def ask(self, case: Any) -> Iterator[Finding]:
        """Yield the findings about a case.Case, each with its stage and certainty."""
        for finding in self.findings(case):
            assert finding.id in self.ids, f"a rule reports {finding.id}, and does not say so"
            finding.stage = self.stage
            finding.certainty = finding.certainty or self.sure or _SURE[self.stage]
            yield finding


# What a rule may need, a member of case.Case -> what that needs in turn.
NEEDS = {
    "manifest": (),
    "model": ("manifest",),
    "launch": ("manifest",),
    "facts": ("model", "launch"),
    "built": ("model",),
    "nodes": ("facts", "built"),
}


def closure(needs: Iterable[str]) -> set[str]:
    """Return all that must be known for what is needed."""
    return {known for need in needs for known in (need, *closure(NEEDS[need]))}
