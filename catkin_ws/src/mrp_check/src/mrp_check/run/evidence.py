# SPDX-License-Identifier: BSD-3-Clause
"""What must have been seen to call a requirement met: without a finding, it may be unobserved.

Each is called with a case.Case, and returns why nobody can say that it is met, or None.
"""

from __future__ import annotations

from typing import Callable, Optional

from mrp_check.contract import spec as specs
from mrp_check.contract.spec import Publishes
from mrp_check.run.case import Case
from mrp_check.run.node import Node

WhyUnseen = Callable[[Case], Optional[str]]


def always(case: Case) -> str | None:
    return None


def manifest(case: Case) -> str | None:
    return None if case.manifest[0] else "package.xml can't be read"


def code(case: Case) -> str | None:
    has_code = case.package.of_kind("python", "cpp")
    return manifest(case) or (None if has_code else "the package has no source")


def cmake(case: Case) -> str | None:
    return None if "CMakeLists.txt" in case.package.files else "there's no CMakeLists.txt"


def launch(case: Case) -> str | None:
    if case.launch and not case.launch.error:
        return None
    is_there = case.package.of_kind("launch")
    return "roslaunch can't read the launch file" if is_there else "there's no launch file"


def built(case: Case) -> str | None:
    if case.built is None:
        return "CMake didn't succeed"
    return None if case.built.ok else "not everything was compiled"


def of_nodes(why: Callable[[Case, str], str | None]) -> WhyUnseen:
    """Return the same of all nodes, for a function of the case and a node's name."""
    return lambda case: next(filter(None, (why(case, name) for name in case.spec.nodes)), None)


def _no_source(case: Case, name: str) -> str | None:
    return None if case.facts.sources.get(name) else f"no source of {name} was found"


def _sources(language: str) -> WhyUnseen:
    """Return the test of whether there is a source of each node that may be in the language."""
    return of_nodes(
        lambda case, name: (
            _no_source(case, name) if case.spec.nodes[name].language in (language, "any") else None
        )
    )


# Each node in that language has a source.
python, cpp = _sources("python"), _sources("cpp")


def _read(case: Case, name: str) -> str | None:
    """Say why it is not known what a node's sources say, nor what the node does."""
    if "nodes" in vars(case) and case.nodes[name].is_up:
        return None
    unread = [f for f in case.facts.sources.get(name, ()) if f in case.facts.unread]
    return f"{unread[0]} can't be read" if unread else _no_source(case, name)


def _python_read(case: Case, name: str) -> str | None:
    kinds = [case.package.kind(file) for file in case.facts.sources.get(name, [])[:1]]
    is_cpp = "cpp" in (*kinds, case.spec.nodes[name].language)
    return None if is_cpp else _read(case, name)


# The sources of each node, or of each in Python, were read; or it ran.
read, python_read = of_nodes(_read), of_nodes(_python_read)


def compiled(case: Case) -> str | None:
    return "CMake didn't succeed" if case.built is None else cpp(case)


def when(
    is_seen: Callable[[Node], object],
    what: str,
    role: Callable[[specs.NodeSpec], object] = lambda node: True,
) -> WhyUnseen:
    """Return the test of nodes that came up, and of which something more must have been seen.

    role: whether the contract asks that of a node of the spec
    """

    def why(case: Case, name: str) -> str | None:
        node = case.nodes[name]
        if not role(node.wanted):
            return None
        if not node.is_up:
            return f"{name} didn't run"
        return None if is_seen(node) else f"{name} {what}"

    return of_nodes(why)


def of_publisher(
    asked: Callable[[Publishes], object], is_seen: Callable[[Node], object], what: str
) -> WhyUnseen:
    """The same of a node that publishes, if its contract says more of it."""
    return when(is_seen, what, lambda wanted: wanted.publishes and asked(wanted.publishes))


up = when(lambda node: True, "")
meets = when(Node.meets, "wasn't seen on its topic")
alone = when(lambda node: node.own_name, "didn't run outside of the launch file")
