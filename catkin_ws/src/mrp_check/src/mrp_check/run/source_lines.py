# SPDX-License-Identifier: BSD-3-Clause
"""Find the source line behind an observed failure."""

from __future__ import annotations

import ast
import re
from typing import Collection, Iterable, Iterator, Tuple

from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Event, Log, Number
from mrp_check.contract.finding import Line, Where
from mrp_check.contract.names import last_part
from mrp_check.package.workspace import Workspace
from mrp_check.run.observing import Observed
from mrp_check.run.planning import WRAP

# Of a traceback, and of what faulthandler prints.
_FRAME = re.compile(r'^\s*File "(?P<path>[^"]+)", line (?P<line>\d+)')
# A class; one of a small letter, such as termios.error, with its module.
_ERROR = re.compile(
    r"^(?:[a-z_]\w*\.)*?(?P<kind>[A-Z]\w*|(?:[a-z_]\w*\.)+[a-z_]\w*)(?:: (?P<text>.*))?$"
)
_ARGUMENTS = re.compile(
    r"TypeError: (?P<text>(?:[\w<>]+\.)*(?P<name>\w+)\(\) (?:takes|missing) .*argument.*)"
)


Traceback = Tuple[Line, str, str]  # its last own line, the error's class, its text


class Places:
    """Finds places: each is (file relative to the package, line), or (None, None).

    What the node itself told while it ran (see confined/hook) is sure; next come the facts
    of the sources.
    """

    def __init__(self, workspace: Workspace, facts: Facts, observed: Observed) -> None:
        self.package, self.facts, self.observed = workspace.package, facts, observed
        self.copy = str(workspace.package_folder.resolve()) + "/"

    def sources(self, node: str) -> list[str]:
        """Return the source files of a node of the spec, the main one first."""
        found = list(self.facts.sources.get(node, []))
        executable = self.observed.executables.get(node)
        stems = {node} | ({executable.stem, executable.name} if executable else set())
        for file in self.package.of_kind("python", "cpp"):
            name = last_part(file)
            if (name in stems or name.rsplit(".", 1)[0] in stems) and file not in found:
                found.append(file)
        return found

    def of(self, node: str, *kinds: Kind) -> Where:
        """Return the place of the first kind that there is: of what the node did, or its sources
        say. In the end it is the line at which the node's main source begins to do something."""
        for kind in kinds:
            for event in self.events(node):
                if event.event == kind.value and event.file:
                    return event.file, event.line
            for place in self.facts.of(node, kind):
                return place.file, place.line
        for kind in (Kind.INIT, Kind.HANDLE):
            for place in self.facts.of(node, kind):
                return place.file, place.line
        for file in self.sources(node):
            return file, self.first_statement(file)
        return self.in_launch_file(node)

    def sleep_beside(self, node: str, *kinds: Kind) -> Line | None:
        """Return the place of a sleep in the same function as a place of these kinds, or None."""
        places, sleeps = self.facts.of(node, *kinds), self.facts.of(node, Kind.SLEEP)
        for function in self.facts.of(node, Kind.FUNCTION):
            beside = [sleep for sleep in sleeps if function.is_around(sleep)]
            if beside and any(function.is_around(place) for place in places):
                return beside[0].file, beside[0].line
        return None

    def of_topic(self, node: str, kind: Kind, topic: str) -> Where:
        """Return the place at which a node names a topic: the kind is publisher or subscriber."""
        base = last_part(topic)
        for event in self.events(node):
            is_named = event.topic is not None and last_part(event.topic) == base
            if event.event == kind.value and is_named:
                return event.file, event.line
        for place in self.facts.of(node, kind):
            if place.text and last_part(place.text) == base:
                return place.file, place.line
        return self.of(node, kind)

    def asked(self, node: str, what: Kind, name: str) -> Where:
        """Return the place at which a node names a service or a parameter; without that name the
        first one of its kind, and without any where the node begins."""
        places = self.facts.asked(self.sources(node), what)
        places.sort(key=lambda place: place.base != name)
        return (places[0].file, places[0].line) if places else self.of(node, Kind.INIT)

    def of_text(self, node: str, text: str) -> Line | None:
        """Return the place at which a text that a node says begins as this one does, or None."""
        begin = re.split(r"\d", text)[0].strip()
        for file in self.sources(node) if begin else ():
            line = self.package.find_line(file, begin)
            if line:
                return file, line
        return None

    def of_setting(self, node: str, fields: Iterable[str]) -> Where | None:
        """Return the place at which a node sets one of these fields of a message, or None."""
        names = "|".join(re.escape(path.split(".")[-1]) for path in fields)
        sets = rf"(\.|->)({names})\s*[-+*/]?=[^=]"
        return self.package.first_match(self.sources(node), sets) if names else None

    def in_launch_file(self, node: str) -> Where:
        started = self.observed.started.get(node)
        if started and started.file:
            return started.file, started.line
        return self.facts.launch.get(node, (None, None))

    def events(self, node: str) -> list[Event]:
        """Return what the node told while it ran by itself."""
        runs = (self.observed.alone(node), self.observed.alone(WRAP + node))
        return [event for run in runs if run for event in run.events]

    def first_statement(self, file: str) -> int:
        """Return the line of a source at which something is done: main(), or the first statement
        that is no import."""
        if self.package.kind(file) == "python":
            skip = (ast.Import, ast.ImportFrom, ast.Expr)
            body = self.package.tree(file).body
            return next((s.lineno for s in body if not isinstance(s, skip)), 1)
        return self.package.find_line(file, " main(", 1)

    def condition_of_publish(self, node: str) -> Line | None:
        """Return the place of the condition before publish() in the same function, or None."""
        publish = self.facts.of(node, Kind.PUBLISH)[:1]
        functions = [
            f for f in self.facts.of(node, Kind.FUNCTION) if publish and f.is_around(publish[0])
        ]
        for function in functions[-1:]:
            lines = self.package.lines(function.file)[function.line - 1 : publish[0].line]
            for number, text in reversed([*enumerate(lines, function.line)]):
                if re.match(r"\s*\}?\s*(if|elif|else if)\b", text):
                    return function.file, number
        return None

    def of_log(self, node: str, log: Log) -> Where:
        """Return the place of a line that a node has logged: /rosout says it."""
        file = self.own(log.file)
        if file:
            return file, log.line
        files = [f for f in self.package.files if last_part(f) == last_part(log.file)]
        sources = self.sources(node)
        files.sort(key=lambda file: (file not in sources, file))
        return (files[0], log.line) if files else self.of(node, Kind.LOG)

    def of_counter(
        self, node: str, names: Collection[str] = (), reset: Number | None = None
    ) -> Where:
        """Return the place at which the counter of a publisher is counted on; or is set back to
        `reset`, if there is such a place."""
        for file in self.sources(node):
            if self.package.kind(file) == "python":
                line = _counting_line(self.package.tree(file), names, reset)
                if line:
                    return file, line
        return self.of(node, Kind.STEP, Kind.COUNTER, Kind.PUBLISH)

    def traceback(self, lines: Iterable[str]) -> Traceback | None:
        """Return (place, error's class, its text) of the last traceback that has a line of the
        package's own code in it, or None."""
        found, place, inside = None, None, False
        for text in lines:
            frame = _FRAME.match(text)
            if text.startswith("Traceback (most recent call last)"):
                inside, place = True, None
            elif frame and (inside or "SyntaxError" not in text):
                own = self.own(frame["path"])
                place = (own, int(frame["line"])) if own else place
                inside = True
            elif inside and text and not text.startswith(" "):
                error = _ERROR.match(text.strip())
                if error:
                    if place:
                        found = (place, error["kind"], error["text"] or "")
                    inside = False
        return found

    def wrong_arguments(self, node: str, lines: Iterable[str]) -> tuple[Line, str] | None:
        """Return (place of the function, text) of a call of one of the package's own functions with
        too many or too few arguments, though no line of the package made it; or None.

        The node's own files come first: others may have a function of that name, too.
        """
        for text in lines:
            found = _ARGUMENTS.match(text.strip())
            if found:
                for file in (*self.sources(node), *self.package.of_kind("python")):
                    line = self.package.find_line(file, f"def {found['name']}(")
                    if line:
                        return (file, line), found["text"]
        return None

    def stack(self, lines: Iterable[str]) -> Line | None:
        """Return the first own place in what faulthandler printed, or None."""
        return next((place for place, _ in self._frames(lines) if place), None)

    def waits_in_rospys_end(self, lines: Iterable[str]) -> bool:
        """Return whether faulthandler printed that rospy's own handler of Ctrl-C waits, in no line
        of the package.

        If Ctrl-C comes while rospy asks the master for something, such as in each line of log, or
        publishes, its handler waits for ever for the lock of the call that it has interrupted.
        """
        for place, text in self._frames(lines):
            if place or text.endswith("in signal_shutdown"):
                return not place
        return False

    def _frames(self, lines: Iterable[str]) -> Iterator[tuple[Line | None, str]]:
        """Yield (its place, if that is the package's own; its text) of each frame."""
        for frame in filter(None, map(_FRAME.match, lines)):
            own = self.own(frame["path"])
            yield ((own, int(frame["line"])) if own else None), frame.string

    def own(self, path: str) -> str | None:
        """Return a path relative to the package, if it is the package's own, or None."""
        return path[len(self.copy) :] if path.startswith(self.copy) else None


def _counting_line(tree: ast.AST, names: Collection[str], reset: Number | None) -> int | None:
    """Return the line at which a name is counted on, as in `counter += 2`, or None."""
    for condition in [node for node in ast.walk(tree) if isinstance(node, (ast.If, ast.IfExp))]:
        for node in ast.walk(condition):
            if isinstance(node, ast.Assign) and _last_name(node.targets[0]) in names:
                if isinstance(node.value, ast.Constant) and node.value.value == reset:
                    return node.lineno
    for node in ast.walk(tree):
        if isinstance(node, ast.AugAssign) and _last_name(node.target) in names:
            return node.lineno
        if isinstance(node, ast.Assign) and _last_name(node.targets[0]) in names:
            used = {_last_name(part) for part in ast.walk(node.value)}
            if _last_name(node.targets[0]) in used:
                return node.lineno
    return None


def _last_name(node: ast.AST) -> str | None:
    return getattr(node, "attr", None) or getattr(node, "id", None)
