# SPDX-License-Identifier: BSD-3-Clause
"""A finding: one thing that is wrong, where it is, and what to do."""

from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

Line = Tuple[str, int]  # a file, relative to the package, and a line of it
Where = Tuple[Optional[str], Optional[int]]  # the same, as far as it is known
Change = Tuple[str, str]  # a part of a line, and what to write for it

# Why a rule is sure that something is wrong.
SEEN = "seen"  # it was seen to fail, or a tool of ROS, CMake, gcc or Python reports it
CERTAIN = "certain"  # a named rule of ROS, CMake or Python rules it out
READ = "read"  # a source says so, and a contract forbids it; nobody has seen it fail
HABIT = "habit"  # it works, but it is fragile
HINT = "hint"  # it works; good to know

# What that means for a package: verdict/severity.py says it.
ERROR, WARNING, NOTE = "error", "warning", "note"


@dataclasses.dataclass
class Finding:
    """One thing that is wrong.

    id: the requirement that is not met, a key of rules.REQUIREMENTS
    message: what is wrong, in one or two full sentences that a beginner understands
    file: relative to the package, or None if no file of the package is to blame
    line: of that file, from 1, or None
    certainty: SEEN, CERTAIN, READ, HABIT or HINT; left out, it is the one of its rule
    expected, seen: what the contract asks for, and what was found; may be empty
    fix: what to do next; below it a unified diff, where the fix is certain
    why: the entry of the page why about the text that a tool prints then, or empty
    change: (old, new), a part of the line and what to write for it, if that is certain to fix it;
            verdict/check.py makes the diff of it, and drops a change that is not certain
    suppressed: the reason why a comment suppresses it, or empty
    consequence_of: the id of the finding that is the cause of this one, or None
    stage: which stage found it; verdict/check.py fills it in
    severity: ERROR, WARNING or NOTE; verdict/check.py fills it in
    node: the name of the spec's node that it is about, or None: tells causes from consequences
    packages: the ROS packages that are not named, or whose headers are not found: the same
    """

    id: str
    message: str
    file: str | None = None
    line: int | None = None
    certainty: str = ""
    expected: str = ""
    seen: str = ""
    fix: str = ""
    why: str = ""
    consequence_of: str | None = None
    stage: str = ""
    node: str | None = None
    packages: tuple[str, ...] = ()
    change: Change | None = None
    suppressed: str = ""
    severity: str = ""
