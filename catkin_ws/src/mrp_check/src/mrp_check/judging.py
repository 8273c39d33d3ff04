# SPDX-License-Identifier: BSD-3-Clause
"""How severe a finding is where no contract says it: an error is what was seen to fail, or what
breaks a rule of ROS without which nothing can work."""

from __future__ import annotations

import re
from typing import Iterable

from mrp_check.case import Case
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import ERROR, NOTE, WARNING, Finding, Line
from mrp_check.contract.words import last_part
from mrp_check.rules.deaf_loop import ASKS_KEYBOARD
from mrp_check.rules.definitions import UNREADABLE
from mrp_check.rules.long_loop import GOES_ON
from mrp_check.rules.messages import CHANCE
from mrp_check.rules.python_names import OLD_NAME
from mrp_check.rules.responses import NO_RESPONSE
from mrp_check.rules.unbuilt import COUNTS
from mrp_check.running.node import Node
from mrp_check.running.traces import ends
from mrp_check.running.words import last_words
from mrp_check.sources import asked, uses

# What neither catkin, nor the compiler, Linux or roslaunch takes: nobody has to see it fail.
_RULES = set(
    (
        "manifest package-name cmake configure compile link python-syntax scripts text targets"
        " launch-file launch-nodes"
    ).split()
)
# The same, by what a finding says.
_SURE = (NO_RESPONSE, "CMake stops", ASKS_KEYBOARD, UNREADABLE, OLD_NAME, CHANCE)
_OF_CMAKE = {"manifest", "package-name", "cmake", "configure"}
_SEEN = {"build", "run", "stop"}
# What a node says that stands before an empty keyboard, screen or command line, what it waits for,
# and what must stand in the line that raised, where anything else raises the same error, too.
_WAITS = (
    (r"(?i)^\s*\W*usage\b|\[ ?\w+\] \[[\d., ]+\]: usage\b", "arguments on its command line", ""),
    (r"EOFError: EOF when reading a line", "the keyboard", ""),
    (r"termios\.error|Inappropriate ioctl for device", "the keyboard", ""),
    (r"(?i)cannot open display|could not connect to display|no display name", "a screen", ""),
    (r"(?i)can.t open camera|VIDEOIO|/dev/(video|tty|input)\w*", "a device", ""),
    (r"KeyError: ", "a parameter", "param"),
    (r"IndexError: list index|ValueError: ", "arguments", "sys.argv["),
)
# Beside the line at which a program ends, it misses some of the arguments that it counts.
_COUNTS = re.compile(COUNTS)
_ENDS = re.compile(r"\bexit\s*\(|\bquit\s*\(|\breturn\s+(-?[1-9]|EXIT_FAILURE)")
_WAITS_FOR_ARGUMENTS = "waits for arguments on its command line"
_ENDS_IN_PEACE = "does its work, and ends"
_FEW = 6  # lines
# The same of a launch file: an argument, a variable of the environment, or another's launch file.
_WANTED = (
    r"argument \w+ has no value|requires the '\w+' arg|environment variable \S+ is not set"
    r"|is not there: \S+\."
)
_OF_ACTIONS = {"feedback", "result", "status"}
_ENDED = ("KeyboardInterrupt", "ROSInterruptException")


def weigh(case: Case, findings: Iterable[Finding]) -> None:
    """Set the severity of what was seen of the nodes. Call it before causes.told_once()."""
    for finding in findings:
        if finding.severity == ERROR and finding.stage in ("run", "stop"):
            _of_run(case, finding)


def judged(case: Case, findings: Iterable[Finding], seen: Iterable[Finding]) -> list[Finding]:
    """Return the findings with the severity that each has for a package without a contract.

    findings: what the report tells; seen: all that was found, with what the report leaves out
    """
    findings = list(findings)
    for finding in findings:
        if finding.consequence_of == "scripts" and not _is_of_scripts(case, finding):
            finding.consequence_of = None
    failed = [f for f in seen if f.stage in _SEEN and f.severity == ERROR]
    confirmed: set[tuple[str | None, str | None]] = {(f.id, f.file) for f in failed}
    confirmed |= {(f.consequence_of, None) for f in failed}
    kept = []
    late = {finding.node for finding in findings if GOES_ON in finding.message}
    stops = any(f.id in _OF_CMAKE and f.severity == ERROR for f in findings)
    for finding in findings:
        is_seen = {(finding.id, finding.file), (finding.id, None)} & confirmed
        if finding.severity == ERROR and finding.stage not in _SEEN and not is_seen:
            if not _is_rule(case, finding):
                wants = finding.id == "launch-file" and _wants(finding)
                finding.severity = NOTE if wants else WARNING
        if finding.severity != ERROR:
            finding.consequence_of = None
        # Only on a busy machine is such a node watched until its loop ends.
        is_late = _ENDS_IN_PEACE in finding.message and finding.node in late
        if not _is_unbuilt(case, finding, stops) and not is_late:
            kept.append(finding)
    errors = {f.id for f in kept if f.severity == ERROR}
    for finding in kept:
        if finding.consequence_of not in errors:
            finding.consequence_of = None
    return kept


def _is_of_scripts(case: Case, finding: Finding) -> bool:
    """Return whether a finding can follow from one about a script.

    In the copy that ran, AnyCase has fixed what keeps Linux from starting a script: see there.
    """
    if finding.stage not in ("run", "stop"):
        return any(script.path not in case.package.files for script in case.model.scripts)
    node = case.nodes.get(finding.node or "")
    return not (node and node.is_up)


def _is_rule(case: Case, finding: Finding) -> bool:
    """Return whether a finding of the sources breaks a rule without which nothing works."""
    is_python = bool(finding.file) and case.package.kind(finding.file or "") == "python"
    if finding.id == "python-syntax":
        return finding.file in {f for files in case.facts.sources.values() for f in files}
    if any(said in finding.message for said in _SURE):
        return True
    if finding.id in ("spin", "lifetime") and not is_python:
        return "publisher that" not in finding.message
    if finding.id == "launch-file":
        return _wants(finding) is None
    return finding.id in _RULES


def _wants(finding: Finding) -> str | None:
    """Return what a launch file wants from its caller or from another package, or None."""
    found = re.search(_WANTED, finding.message)
    return found.group(0) if found else None


def _of_run(case: Case, finding: Finding) -> None:
    """Weigh what was seen of a node: it may have waited for what only its user has."""
    node = case.nodes.get(finding.node or "") if "nodes" in vars(case) else None
    if node is None:
        return
    own = rf"(No module named|cannot import name .* from) '{case.package.name}\b"
    if case.built is None and re.search(own, finding.message):
        finding.severity = NOTE  # it is not made where CMake failed
    elif finding.id == "exit":
        # Whatever its exit code, it ended: roslaunch asks for no more.
        ends = node.direct and (node.direct.code or 0) > 0
        if ends or any(word in finding.message for word in _ENDED):
            finding.severity = WARNING
    elif finding.stage == "run" and finding in node.not_up:
        _of_start(case, node, finding)
        started = _without_arguments(case, node)
        if finding.severity == NOTE and _WAITS_FOR_ARGUMENTS in finding.message and started:
            finding.message = f"{node.name} {_WAITS_FOR_ARGUMENTS}, and {started.file} gives none."
            finding.severity, finding.file, finding.line = WARNING, started.file, started.line


def _without_arguments(case: Case, node: Node) -> Started | None:
    """Return a <node> of a launch file that starts a node, and gives it no arguments."""
    started = (one for launch in case.launches for one in launch.nodes)
    own = (one for one in started if (one.package, one.type) == (case.package.name, node.name))
    return next((one for one in own if not one.arguments.strip() and one.file), None)


def _of_start(case: Case, node: Node, finding: Finding) -> None:
    lines = [text for _, _, text in node.direct.lines] if node.direct else []
    for shape, what, reads in _WAITS:
        said = next((text for text in lines if re.search(shape, text)), None)
        if said:
            if reads not in _source(node, finding):
                continue
            finding.severity = WARNING if what == "a parameter" else NOTE
            finding.message = f"{node.name} waits for {what}: {said.strip()[:200]}"
            return
    if not any("Error:" in line for line in lines) and misses_arguments(node, finding):
        finding.severity = NOTE
        finding.message = f"{node.name} {_WAITS_FOR_ARGUMENTS}."
        return
    file = _works_under(case, node)
    if file:
        finding.severity = NOTE
        finding.message = f"{node.name} works under {file}; started by itself, it ends."
        return
    early = _early_call(node, lines)
    if early:
        finding.severity, (finding.file, finding.line) = WARNING, early
        finding.message += " It does not wait for the service that it calls."
        return
    if node.direct and node.direct.code == 0 and not _is_left_alone(node):
        finding.severity = NOTE
        finding.message = f"{node.name} {_ENDS_IN_PEACE}: {last_words(lines) or 'in peace'}"


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
    return asked.unwaited(node.package, node.places.sources(node.name))


def misses_arguments(node: Node, finding: Finding) -> bool:
    """Return whether a program counts its arguments beside where it ended; or, where that place
    is not known, beside any line that ends it."""
    if not finding.file or not finding.line:
        return False
    lines = node.package.lines(finding.file)
    begin, end = max(finding.line - _FEW, 0), finding.line + _FEW
    if any(map(_COUNTS.search, lines[begin:end])):
        return True
    code = node.direct.code if node.direct else 0
    counting = [number for number, text in enumerate(lines) if _COUNTS.search(text)]
    return bool(code) and any(any(map(_ENDS.search, lines[n : n + 2 * _FEW])) for n in counting)


def _source(node: Node, finding: Finding) -> str:
    lines = node.package.lines(finding.file) if finding.file else []
    return lines[finding.line - 1] if finding.line and finding.line <= len(lines) else ""


def _is_left_alone(node: Node) -> bool:
    """Return whether a node ended that was to be called back."""
    heard = {one.topic for one in node.seen_alone.subscriptions}
    files = node.places.sources(node.name)
    if node.package.first_match(files, r"\bSimpleActionClient\b"):
        # Those of the client itself call nothing of the node's.
        heard = {topic for topic in heard if last_part(topic) not in _OF_ACTIONS}
    return bool(heard)


def _is_unbuilt(case: Case, finding: Finding, stops: bool) -> bool:
    """Return whether a node has no executable only as something on this machine is missing.

    stops: whether CMake stops at a fault of the package's own
    """
    if finding.id != "starts" or "has no executable" not in finding.message:
        return False
    is_cause = finding.consequence_of is None or case.built is None and not stops
    sources = case.facts.sources.get(finding.node or "", ())
    headers = (one for file in sources for one, _ in uses.includes(case.package, file))
    is_cause = is_cause or any(uses.absent_header(case.package, header) for header in headers)
    return is_cause and not (case.built and case.built.ok)
