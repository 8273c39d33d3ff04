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
    return [
        place
        for place in facts.places
        if place.kind in _ASKED and place.file in files and place.base
    ]


def unwaited(facts: Facts, files: Container[str]) -> Place | None:
    """Return where these sources call a service, if they never wait for any."""
    places = [place for place in facts.places if place.file in files]
    if any(place.kind is Kind.WAITS for place in places):
        return None
    calls = [place for kind in (Kind.CALLS, Kind.ASKS) for place in places if place.kind is kind]
    return calls[0] if calls else None
