# SPDX-License-Identifier: BSD-3-Clause
"""A row of an adapter's table: what to say where a tool reports one of its ids."""

from __future__ import annotations

from typing import NamedTuple

from mrp_check.contract.finding import HABIT, Finding
from mrp_check.package.package import Package


class Row(NamedTuple):
    """What to say where a tool reports one of its ids.

    says: our sentence; fix: what to do; why: the entry of the page why
    certainty: how sure it is that something is wrong; never more than READ, as nothing ran
    """

    says: str
    fix: str = ""
    certainty: str = HABIT
    why: str = ""

    def finding(
        self, id_: str, package: Package, file: str, line: int | None, name: str, message: str
    ) -> Finding:
        """Return the Finding about a line; the tool's own words are what was seen.

        name: of the tool, and what it calls this
        """
        seen = f"{package.line(file, line)}  ({message})" if line else message
        expected, place = f"nothing that {name}", (file, line, self.certainty)
        return Finding(id_, self.says, *place, expected, seen, self.fix, self.why)
