# SPDX-License-Identifier: BSD-3-Clause
"""What the sources say: where each node's name, topics, messages, counters and lines are.

The later stages use it to name the file and the line of what they see happen.
"""

from __future__ import annotations

import dataclasses
from typing import Container

from mrp_check.code.python_source import Source
from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import Finding


@dataclasses.dataclass
class Facts:
    """What all sources say.

    places: of all sources, in order
    sources: name of a node of the spec -> the files it is made of, the main one first
    launch: name of a node of the launch file -> (file, line of its <node>)
    unread: the files that could not be read to their end: what they lack proves nothing
    problems: the Findings that say why not, of those in Python
    python: file -> python_source.Source
    relevant: the Python files that are nodes, or that nodes are made of
    """

    places: list[Place] = dataclasses.field(default_factory=list)
    sources: dict[str, list[str]] = dataclasses.field(default_factory=dict)
    launch: dict[str, tuple[str, int]] = dataclasses.field(default_factory=dict)
    unread: set[str] = dataclasses.field(default_factory=set)
    problems: list[Finding] = dataclasses.field(default_factory=list)
    python: dict[str, Source] = dataclasses.field(default_factory=dict)
    relevant: list[str] = dataclasses.field(default_factory=list)

    def of(self, node: str, *kinds: Kind) -> list[Place]:
        """Return the places of these kinds in the sources of a node of the spec, in order."""
        files = self.sources.get(node, [])
        found = [p for p in self.places if p.file in files and (not kinds or p.kind in kinds)]
        return sorted(found, key=lambda place: (files.index(place.file), place.line))

    def asked(self, files: Container[str], kind: Kind) -> list[Place]:
        """Return where these sources name a service, an action or a parameter of a kind."""
        places = (place for place in self.places if place.kind is kind)
        return [place for place in places if place.file in files and place.base]

    def exits(self, node: str) -> list[Place]:
        """Return where the sources of a node end it by a call, such as of exit()."""
        return [place for place in self.of(node, Kind.EXIT) if place.text != "return"]

    def first(self, *kinds: Kind) -> tuple[str | None, int | None]:
        """Return the (file, line) of the first of these kinds that any source has."""
        for kind in kinds:
            for place in self.places:
                if place.kind is kind:
                    return place.file, place.line
        return None, None

    def end_of_main(self, node: str) -> tuple[str, int] | None:
        """Return where the function ends that starts the node: there a call belongs that is
        missing. None if it is no function."""
        inits, functions = self.of(node, Kind.INIT), self.of(node, Kind.FUNCTION)
        mains = [f for f in functions if (f.is_around(inits[0]) if inits else f.text == "main")]
        ends = [p for p in self.of(node, Kind.EXIT) if p.text == "return"]
        if ends or not mains:
            return (ends[-1].file, ends[-1].line) if ends else None
        return mains[-1].file, mains[-1].end

    def absent(self, node: str | None = None) -> dict[str, str]:
        """Return module -> sentence, of what a node's sources import and this machine has not.

        node: all nodes of the spec if None
        """
        names = [node] if node else self.sources
        sources = [self.python.get(file) for name in names for file in self.sources.get(name, ())]
        return {
            module: text for source in sources if source for module, text in source.absent.items()
        }
