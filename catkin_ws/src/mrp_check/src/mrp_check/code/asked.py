# SPDX-License-Identifier: BSD-3-Clause
"""Which services, actions and parameters the sources ask for, and which they give."""

from __future__ import annotations

from typing import Container

from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind, Place

_ASKED = {
    *(Kind.ASKS, Kind.OFFERS, Kind.READS, Kind.KNOWS, Kind.SETS, Kind.COMMANDS, Kind.SERVES),
}


def of(facts: Facts, files: Container[str]) -> list[Place]:
    """Return where these sources name one."""
    return [one for one in facts.places if one.kind in _ASKED and one.file in files and one.base]


def unwaited(facts: Facts, files: Container[str]) -> Place | None:
    """Return where these sources call a service, if they never wait for any."""
    places = [one for one in facts.places if one.file in files]
    if any(one.kind is Kind.WAITS for one in places):
        return None
    calls = [one for kind in (Kind.CALLS, Kind.ASKS) for one in places if one.kind is kind]
    return calls[0] if calls else None
