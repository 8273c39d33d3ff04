# SPDX-License-Identifier: BSD-3-Clause
"""A node of the spec, as its sources tell it."""

from __future__ import annotations

import functools
import os
from typing import Any, Callable, Iterable, Iterator, Protocol

from mrp_check.code.facts import Facts
from mrp_check.confined.launch_dump import Started
from mrp_check.confined.places import Kind, Place
from mrp_check.contract import spec as specs
from mrp_check.contract.finding import Finding, Line
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec, Topic
from mrp_check.package.cmake import Model
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package


def nodes(
    package: Package, spec: Spec, model: Model, launch: Launch | None, facts: Facts
) -> list[SourceNode]:
    """Return the SourceNodes of the spec whose sources could all be read."""
    started = {node.name: node for node in (launch.nodes if launch else [])}
    files = {name: facts.sources.get(name, []) for name in spec.nodes}
    return [
        SourceNode(package, spec, model, node, started.get(name), facts)
        for name, node in spec.nodes.items()
        if files[name] and not facts.unread & {*files[name]}
    ]


class SourceNode:
    """What the sources of a node of the spec say of it.

    wanted: what the spec says of it
    files: its sources, main the first of them
    started: the launch.Started that it is, or None
    """

    def __init__(
        self,
        package: Package,
        spec: Spec,
        model: Model,
        wanted: specs.NodeSpec,
        started: Started | None,
        facts: Facts,
    ) -> None:
        self.package, self.spec, self.model = package, spec, model
        self.wanted, self.name, self.started, self.facts = wanted, wanted.name, started, facts
        self.files = facts.sources[self.name]
        self.main = self.files[0]
        self.is_python = package.kind(self.main) == "python"

    def places(self, *kinds: Kind) -> list[Place]:
        return self.facts.of(self.name, *kinds)

    def on_topic(self, kind: Kind, topic: Topic | None) -> list[Place]:
        """Return the places of a kind that are about the topic, or may be."""
        return [
            p
            for p in self.places(kind)
            if topic and (p.text is None or p.text.strip("~/").split("/")[-1] == topic.name)
        ]

    def finding(self, id_: str, message: str, place: Place | Line, **more: Any) -> Finding:
        if not isinstance(place, tuple):
            place = (place.file, place.line)
        more.setdefault("seen", self.package.line(place[0], place[1]))
        return Finding(id_, message, *place, node=self.name, **more)

    @property
    def executable(self) -> str:
        return self.started.type if self.started else self.name

    @functools.cached_property
    def mistaken_for(self) -> specs.NodeSpec | None:
        """The node of the spec whose sources these are in truth, or None."""
        if not self.spec.is_contract:
            return None
        names = {p.text for p in self.places(Kind.INIT)}
        others = [n for n in names if n in self.spec.nodes and n != self.name]
        if len(names) != 1 or not others:
            return None
        other = self.spec.nodes[others[0]]
        own = self._has_role() and not self._is_called(self.main, other.name)
        return None if own or not self.mistaken_in(other) else other

    def mistaken_in(self, other: specs.NodeSpec) -> str | None:
        """Return what gives the node the sources of another: targets, launch-nodes, or None."""
        stem, belongs = os.path.splitext(self.executable)[0], self._belongs(other)
        is_target = self.executable in self.model.executables()
        if is_target and stem != other.name and belongs:
            return "targets"
        in_launch = self.started is not None and self.started.file and stem != self.name
        return "launch-nodes" if in_launch and (stem == other.name or belongs) else None

    def _has_role(self) -> bool:
        """Return whether the sources do what the node is for: publish, or subscribe."""
        kinds = {p.kind for p in self.facts.places if p.file in self.files}
        roles = {"publisher": self.wanted.publishing, "subscriber": self.wanted.subscribing}
        return {kind for kind, topic in roles.items() if topic} <= kinds

    @staticmethod
    def _is_called(file: str, name: str) -> bool:
        return os.path.splitext(last_part(file))[0] == name

    def _belongs(self, other: specs.NodeSpec) -> bool:
        """Return whether the main source is another node's: it is called so, or is used so, or the
        other's says that it is this one's."""
        return (
            self._is_called(self.main, other.name)
            or self.facts.sources.get(other.name, [None])[0] == self.main
            or self.name in {place.text for place in self.facts.of(other.name, Kind.INIT)}
        )

    def own_source(self) -> str | None:
        """Return the source that says of itself that it is this node, or None."""
        for place in self.facts.places:
            if place.kind is Kind.INIT and place.text == self.name:
                return place.file
        spare = [
            path
            for path in self.package.of_kind("cpp")
            if not any(path in files for files in self.facts.sources.values())
        ]
        return next(
            (p for p in spare if self._is_called(p, self.name)),
            spare[0] if len(spare) == 1 else None,
        )


class HasCoded(Protocol):
    """A case.Case, as far as each_node() needs one."""

    @property
    def coded(self) -> Iterable[SourceNode]: ...


def each_node(
    findings: Callable[[SourceNode], Iterable[Finding]],
) -> Callable[[HasCoded], Iterator[Finding]]:
    """Return the function of a case.Case that asks this of each SourceNode that is made of its own
    sources: whatever those of another say is said of that one."""

    def of_all(case: HasCoded) -> Iterator[Finding]:
        for node in case.coded:
            if not node.mistaken_for:
                yield from findings(node)

    return of_all
