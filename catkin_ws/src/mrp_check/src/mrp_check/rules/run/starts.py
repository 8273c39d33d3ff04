# SPDX-License-Identifier: BSD-3-Clause
"""Each node starts and stays up."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.code.facts import Facts
from mrp_check.confined.launch_dump import Started
from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, HINT, Finding, Line, Where
from mrp_check.contract.names import last_part
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.run.node import Node
from mrp_check.run.observing import Observed
from mrp_check.run.traces import ROS_TOPICS, ends
from mrp_check.run.words import code_text, last_words

_ARGUMENTS, _PARAMETER = "arguments on its command line", "a parameter"
_DEVICE = "a device"
# What a node says that stands before an empty keyboard, screen or command line, what it waits for,
# and what the line that raised must name, where anything else raises the same error, too.
_WAITS = (
    (r"(?i)^\s*\W*usage\b|\[ ?\w+\] \[[\d., ]+\]: usage\b", _ARGUMENTS, ""),
    (r"EOFError: EOF when reading a line", "the keyboard", ""),
    (r"termios\.error|Inappropriate ioctl for device", "the keyboard", ""),
    (r"(?i)cannot open display|could not connect to display|no display name", "a screen", ""),
    (r"(?i)can.t open camera|VIDEOIO|/dev/(video|tty|input)\w*", _DEVICE, ""),
    (r"KeyError: ", _PARAMETER, "param"),
    (r"IndexError: list index|ValueError: ", "arguments", "sys.argv"),
)
# The last words of a node that names a parameter as missing.
_NO_PARAMETER = re.compile(
    r"(?i)\bparam(eter)?s?\b.*\b(required|missing|not)\b"
    r"|\b(required|missing|no|not|failed|unable)\b.*\bparam(eter)?s?\b"
)
_WAITS_FOR_ARGUMENTS = f"waits for {_ARGUMENTS}"
_FEW = 6  # lines
_OF_ACTIONS = {"feedback", "result", "status"}


def findings(case: Case) -> Iterator[Finding]:
    yield from _problems(case)
    yield from _launch_findings(case.package, case.observed)
    yield from _killed(case.facts, case.observed)
    for node in case.nodes.values():
        if not node.has_executable and not _lacks_what_is_not_here(case, node):
            yield node.finding(
                "starts",
                f"{node.name} couldn't be run: it has no executable.",
                node.places.in_launch_file(node.name),
                expected=f"an executable for {node.name}",
            )
    for node in case.nodes.values():
        for finding in node.not_up:
            if not case.spec.is_contract:
                weigh_start(case, node, finding)
            yield finding


def _lacks_what_is_not_here(case: Case, node: Node) -> bool:
    """Return whether a node was not built only as this machine lacks what it needs."""
    if case.spec.is_contract or case.built and case.built.ok:
        return False
    files = case.facts.sources.get(node.name, ())
    headers = (one for file in files for one, _ in uses.includes(case.package, file))
    return any(uses.absent_header(case.package, header) for header in headers)


def _problems(case: Case) -> Iterator[Finding]:
    for problem in case.observed.problems:
        yield Finding(
            "starts",
            f"The nodes couldn't be run: {problem}.",
            *_launch_place(case.package, case.observed),
            expected="nodes that can be started",
        )


def _launch_findings(package: Package, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if roslaunch gives up, and ends what it has started."""
    if not seen.own_launch or not seen.launch or seen.launch.ending != "itself":
        return
    texts = [text for _, _, text in seen.launch.lines if text.strip()]
    for index, text in enumerate(texts):
        if not text.startswith("RLException: "):
            continue
        said = " ".join(texts[index : index + 2]).partition(": ")[2]
        named = re.search(r"__name:=(\w+)", said)
        why = said.partition(" __name:=")[0]
        started = seen.started.get(named.group(1)) if named else None
        place = _launch_place(package, seen)
        if started and started.file:
            place = started.file, started.line
        prefix = f' launch-prefix="{started.prefix}"' if started and started.prefix else ""
        yield Finding(
            "starts",
            f"roslaunch gives up, and ends all nodes: {why}",
            *place,
            expected="a command that can be run for each node",
            seen=why,
            fix=f"Remove{prefix}: it starts the node with another program." if prefix else "",
            node=named.group(1) if named else None,
        )
        return


def _killed(facts: Facts, seen: Observed) -> Iterator[Finding]:
    """Yield a Finding if something has killed roslaunch: only the package itself can reach it."""
    code = seen.launch.code if seen.launch else None
    if code is not None and code < 0:
        yield Finding(
            "starts",
            "A node kills roslaunch, and perhaps the other nodes.",
            *facts.first(Kind.KILLS, Kind.STARTS),
            expected="nodes that end only themselves",
            seen=f"roslaunch ended {code_text(code)}",
        )


def _launch_place(package: Package, seen: Observed) -> Where:
    for started in seen.started.values():
        if started.file:
            return started.file, started.line
    return ("CMakeLists.txt" if "CMakeLists.txt" in package.files else "package.xml"), 1


def weigh_start(case: Case, node: Node, finding: Finding) -> None:
    """Lower the certainty of a finding about a node that ended, if it waited for what only its user
    or its launch file gives; without a contract, nobody says that it must run by itself."""
    own = rf"(No module named|cannot import name .* from) '{case.package.name}\b"
    if case.built is None and re.search(own, finding.seen):
        finding.certainty = HINT  # it is not made where CMake failed
        return
    waits = _of_start(case, node, finding)
    started = _without_arguments(case, node)
    if waits and started:
        finding.message = f"{node.name} {_WAITS_FOR_ARGUMENTS}, and {started.file} gives none."
        finding.certainty, finding.file, finding.line = HABIT, started.file, started.line


def _without_arguments(case: Case, node: Node) -> Started | None:
    """Return a <node> of a launch file that starts a node, and gives it no arguments."""
    started = (one for launch in case.launches for one in launch.nodes)
    own = (one for one in started if (one.package, one.type) == (case.package.name, node.name))
    return next((one for one in own if not one.arguments.strip() and one.file), None)


def _of_start(case: Case, node: Node, finding: Finding) -> bool:
    """Do so; return whether it waits for arguments on its command line."""
    lines = [text for _, _, text in node.direct.lines] if node.direct else []
    dies = _dies_under(case, node)
    params = [str(value) for launch in case.launches for value in launch.params.values()]
    has_device = any(value.startswith("/dev/") for value in params)
    for shape, what, reads in _WAITS:
        if dies and what in (_ARGUMENTS, "arguments", _PARAMETER):
            continue  # its launch file should give them
        if what == _DEVICE and has_device:  # a library that opens it needn't name it
            shape += "|No such file or directory"
        said = next((text for text in lines if re.search(shape, text)), None)
        if said:
            if reads and not any(reads in name for name in _names(node, finding)):
                continue
            finding.certainty = HABIT if what == _PARAMETER else HINT
            finding.message = f"{node.name} waits for {what}: {said.strip()[:200]}"
            return what == _ARGUMENTS
    if dies:
        finding.message = f"{finding.message.rstrip('.')}. It dies under {dies}, too."
        add_name_that_is_set(case, finding)
        return False
    said = last_words(node.errors())
    if finding.id == "starts" and _NO_PARAMETER.search(said):
        finding.certainty = HINT
        finding.message = f"{node.name} waits for {_PARAMETER}: {said}"
        return False
    if not any("Error:" in line for line in lines) and misses_arguments(node, finding):
        finding.certainty = HINT
        finding.message = f"{node.name} {_WAITS_FOR_ARGUMENTS}."
        return True
    file = _works_under(case, node)
    if file:
        finding.certainty = HINT
        finding.message = f"{node.name} works under {file}; started by itself, it ends."
        return False
    early = _early_call(node, lines)
    if early:
        finding.certainty, (finding.file, finding.line) = HABIT, early
        finding.message += " It doesn't wait for the service that it calls."
        return False
    if node.direct and node.direct.code == 0 and _is_left_alone(node):
        if node.places.facts.exits(node.name):  # it may have meant to, as of what it was answered
            finding.certainty = HABIT
    elif node.direct and node.direct.code == 0:
        finding.certainty = HINT
        finding.message = f"{node.name} exits with code 0: {last_words(lines) or 'without a word'}"
    return False


def add_name_that_is_set(case: Case, finding: Finding) -> None:
    """Add the name under which a launch file sets the parameter that a node doesn't find."""
    asked_for = re.search(r"KeyError: '[~/]?([^']+)'", finding.seen)
    given = (name for launch in case.launches for name in launch.params)
    other = next((one for one in given if asked_for and one.endswith(f"/{asked_for[1]}")), None)
    if other:
        finding.message += f" The launch file sets {other}, which is another name."
        finding.fix = (
            "Set it inside <node> if the node asks for it with ~, and outside if it asks without."
        )


def _dies_under(case: Case, node: Node) -> str | None:
    """Return a launch file of the package under which a node dies, whatever it says then."""
    for launched in case.observed.launches:
        codes = ends(launched.seen.until_asked(0))
        paths = [path for path, name in launched.nodes.items() if name == node.name]
        if launched.file and any(codes.get(path) for path in paths):
            return launched.file
    return None


def _works_under(case: Case, node: Node) -> str | None:
    """Return a launch file under which a node came up, and did not end."""
    for launched in case.observed.launches:
        seen = launched.seen.seen
        up = {one.node for one in [*seen.publications, *seen.subscriptions, *seen.services]}
        died = {*ends(launched.seen.until_asked())}
        paths = {path for path, name in launched.nodes.items() if name == node.name}
        if launched.file and paths & up - died:
            return launched.file
    return None


def _early_call(node: Node, lines: list[str]) -> Line | None:
    """Return the call of a service, if the node ends as nobody offers it yet."""
    raised = any("Traceback" in line for line in lines)
    if not node.direct or (node.direct.code or 0) <= 0:
        return None
    if raised and not any("ServiceException" in line for line in lines):
        return None
    place = node.places.facts.unwaited(node.places.sources(node.name))
    return (place.file, place.line) if place else None


def misses_arguments(node: Node, finding: Finding) -> bool:
    """Return whether a program counts its arguments beside where it ended; or, where that place
    is not known, beside any line that ends it."""
    if not finding.file or not finding.line:
        return False
    places = [one for one in node.places.facts.places if one.file == finding.file]
    counting = [one.line for one in places if one.kind is Kind.COUNTS]
    if any(abs(line - finding.line) <= _FEW for line in counting):
        return True
    code = node.direct.code if node.direct else 0
    exits = [p.line for p in places if p.kind is Kind.EXIT and (p.value or p.text != "return")]
    return bool(code) and any(0 <= end - n < 2 * _FEW for end in exits for n in counting)


def _names(node: Node, finding: Finding) -> set[str]:
    """Return the names in the line of a Python source that raised."""
    source = node.places.facts.python.get(finding.file or "")
    if source is None:
        return set()
    named = [one for one in source.nodes(ast.Attribute) if one.lineno == finding.line]
    return {source.dotted(one) or one.attr for one in named}


def _is_left_alone(node: Node) -> bool:
    """Return whether a node ended that was to be called back."""
    heard = {registration.topic for registration in node.seen_alone.subscriptions} - ROS_TOPICS
    if node.places.facts.of(node.name, Kind.COMMANDS):
        # Those of the client itself call nothing of the node's.
        heard = {topic for topic in heard if last_part(topic) not in _OF_ACTIONS}
    return bool(heard)


RULE = Rule(
    stage="run",
    needs=("nodes",),
    findings=findings,
    requirements={"starts": Requirement("Each node starts and stays up", "launching", evidence.up)},
    also=("spin", "scripts", "python-names", "python-syntax", "type", "node-start"),
)
