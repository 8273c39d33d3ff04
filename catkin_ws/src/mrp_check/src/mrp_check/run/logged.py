# SPDX-License-Identifier: BSD-3-Clause
"""What the nodes logged in their recorded runs, and the page's entry that answers such a line."""

from __future__ import annotations

import functools
import pathlib
import re
from typing import Iterator, NamedTuple

from mrp_check.confined.seen import DirectResult, Log, OutputLine, Seen
from mrp_check.contract.names import last_part
from mrp_check.package.package import Package
from mrp_check.run.observing import Observed, ends

# The entries that explain error texts: a folder beside the tutorial's pages. A checker that is
# installed by itself has none.
ENTRIES = pathlib.Path(__file__).resolve().parents[4] / "mrp/doc/why"
_ENTRY = re.compile(r"\[([a-z][\w-]*)\]")
_TEXT = re.compile(r"(?:Shows|Also): (?:\d\d\| )?(.+)")
# How roscpp and rospy begin a line on the console; and what differs from one run to the next.
_HEAD = re.compile(r"^\[ ?[A-Z]+\] \[[\d., ]+\]:? ")
_VARIABLE = re.compile(
    r"""<[^>]*>|\[[^]]*\]|'[^']*'|"[^"]*"|\{[^}]*\}|(?<![\w.])/[\w/.-]+|\d[\d.]*"""
)
_FEWEST = 3  # words of an entry's text, without what differs


class Run(NamedTuple):
    """A recorded run of a node.

    where: in the words of a message, such as "under launch/all.launch"
    is_launched: whether it ran under a launch file of the package
    logs: its lines on /rosout before it was asked to end
    lines: what was printed until then, by all nodes of a launch file
    path: the node's full name in it
    seen: what was seen of all nodes; asked: when they were to end
    ended: the node's exit code, if it has ended by itself
    latched: topic -> the nodes that latch it
    """

    node: str
    where: str
    is_launched: bool
    path: str
    logs: list[Log]
    lines: list[OutputLine]
    seen: Seen
    asked: float
    ended: int | None
    latched: dict[str, list[str]]


def runs(observed: Observed) -> Iterator[Run]:
    """Yield each node's runs: under the launch files, and by itself."""
    launches = [(run.where, bool(run.file), run.nodes, run.seen) for run in observed.launches]
    if observed.launch:
        paths = {started.path: name for name, started in observed.started.items()}
        launches.append(("under the launch file", True, paths, observed.launch))
    for where, is_launched, paths, launch in launches:
        before = [line for line in launch.lines if line[0] < launch.asked]
        codes = ends(text for _, _, text in before)
        for path, node in paths.items():
            logs = [log for log in launch.seen.logs if log.node == path and log.time < launch.asked]
            rest = launch.seen, launch.asked, codes.get(path), launch.latched
            yield Run(node, where, is_launched, path, logs, before, *rest)
    direct = observed.direct or DirectResult()
    for node, alone in direct.nodes.items():
        if alone.name:
            path, asked = alone.name, alone.asked or alone.ended_after or 0.0
            logs = [log for log in direct.seen.logs if log.node == path and log.time < asked]
            before = [line for line in alone.lines if line[0] < asked]
            ended = alone.code if alone.ended_after is not None else None
            rest = direct.seen, asked, ended, direct.latched
            yield Run(node, "started by itself", False, path, logs, before, *rest)


def is_own(package: Package, log: Log) -> bool:
    """Return whether a line is logged by the package's code: rospy says the file's name, and
    roscpp the path that the compiler was given."""
    names = {last_part(file) for file in package.files}
    is_library = log.file.startswith(("/usr/", "/opt/", "/tmp/binarydeb/", "./", "../"))
    return last_part(log.file) in names and not is_library


def answer(text: str) -> str:
    """Return the name of the entry of the folder why that answers a line; empty if none does, or
    if there is no such folder."""
    line_shape = _shape(text)
    found = [(len(shape), name) for shape, name in entries() if shape in line_shape]
    return max(found)[1] if found else ""


def _shape(text: str) -> str:
    return " ".join(_VARIABLE.sub("#", _HEAD.sub("", text)).lower().split())


@functools.lru_cache(maxsize=None)
def entries() -> list[tuple[str, str]]:
    """Return (what stays the same of a text, name of its entry), of each text of each entry."""
    found, name = [], ""
    for file in sorted(ENTRIES.glob("*.txt")):
        for line in file.read_text(encoding="utf-8").splitlines():
            entry, text = _ENTRY.fullmatch(line), _TEXT.match(line)
            name = entry[1] if entry else name
            shape = _shape(text[1]) if text else ""
            if len(re.findall(r"[a-z]+", shape)) >= _FEWEST:
                found.append((shape, name))
    return found
