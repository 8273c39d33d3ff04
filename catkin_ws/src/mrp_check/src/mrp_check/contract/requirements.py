# SPDX-License-Identifier: BSD-3-Clause
"""What a rule and a requirement are. The rules themselves are the files of rules/."""

from __future__ import annotations

import typing
from typing import Callable, Iterable, Mapping

from mrp_check.contract.finding import Finding

STAGES = ("files", "static", "build", "run", "stop")
CONTRACT, ANY = "contract", "any"


class Requirement(typing.NamedTuple):
    """What a package must meet.

    title: a sentence that is true of a package which meets it
    section: page of the tutorial, and the anchor on it
    seen: called with a case.Case; says why nobody can know whether it is met, or returns None
    shown: where among its stage's requirements it is shown, if not where its rule is asked
    stage: in whose group it is shown: that of its rule
    """

    title: str
    section: str
    seen: Callable[..., str | None]
    shown: int | None = None
    stage: str = ""

    @property
    def page(self) -> str:
        """Where it is explained: a file of the built pages, and the place in it."""
        page, _, anchor = self.section.partition("#")
        return f"pages/{page}.html" + (f"#{anchor}" if anchor else "")


class Rule(typing.NamedTuple):
    """A rule, which can find requirements not met.

    stage, order: when it is asked: causes come before what follows from them
    needs: what it looks at, names in NEEDS
    findings: called with a case.Case, yields a Finding for each thing that is wrong
    requirements: id -> Requirement, of those that it stands for
    also: ids of other rules' requirements that it can report, too
    only: CONTRACT if it compares with what a contract says, ANY if it is for packages without one
    """

    stage: str
    order: int
    needs: tuple[str, ...]
    findings: Callable[..., Iterable[Finding]]
    requirements: Mapping[str, Requirement] = {}
    also: tuple[str, ...] = ()
    only: str = ""

    @property
    def ids(self) -> tuple[str, ...]:
        return (*self.requirements, *self.also)


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
    return {one for need in needs for one in (need, *closure(NEEDS[need]))}
