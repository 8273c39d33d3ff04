# SPDX-License-Identifier: BSD-3-Clause
"""What a package's CMakeLists.txt says: from CMake's own trace, or read as text where CMake failed.

The trace has each call with its arguments as CMake sees them: variables, lists, loops, functions
and globs are all resolved.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import re
import typing
from typing import Collection, Iterable, Mapping, Sequence

from mrp_check.confined import written
from mrp_check.contract.names import line_of

_CALLED = re.compile(r"^\s*\w+\s*\(")  # where a call begins


class Command(typing.NamedTuple):
    command: str  # in lower case
    arguments: list[str]
    file: str  # relative to the package
    line: int

    def line_of(self, lines: Sequence[str], word: str) -> int:
        """Return the line of the file's lines in which a word of the call stands; or its first."""
        is_word = re.compile(rf"^[^#]*(?<![\w-]){re.escape(word)}(?![\w-])")
        for number, text in enumerate(lines[self.line - 1 :], self.line):
            if number > self.line and _CALLED.match(text):
                break
            if is_word.search(text):
                return number
        return self.line


@dataclasses.dataclass
class Target:
    """An executable or a library. Sources are relative to the package if they are of it."""

    name: str
    file: str
    line: int
    is_library: bool = False
    output: str = ""
    sources: list[str] = dataclasses.field(default_factory=list)
    missing: list[tuple[str, str, int]] = dataclasses.field(
        default_factory=list
    )  # sources that do not exist
    links: list[str] = dataclasses.field(default_factory=list)
    link_line: int | None = None
    dependencies: list[str] = dataclasses.field(default_factory=list)


class Script(typing.NamedTuple):
    path: str  # relative to the package, as far as it is of it
    file: str
    line: int
    by: str  # catkin_install_python or install


def traced(trace: pathlib.Path, package_folder: pathlib.Path) -> list[Command]:
    """Return the Calls in a file that CMake's --trace-format=json-v1 made, of the package alone."""
    calls: list[Command] = []
    try:
        text = written.read(trace).decode("utf-8", "replace")
    except OSError:
        return calls
    for line in text.splitlines():
        try:
            entry = json.loads(line)
        except ValueError:
            continue
        file = relative(entry.get("file", ""), package_folder)
        if file is not None:
            arguments = [part for text in entry["args"] for part in text.split(";") if part]
            calls.append(Command(entry["cmd"].lower(), arguments, file, entry["line"]))
    return calls


def relative(path: str | pathlib.Path, folder: pathlib.Path) -> str | None:
    """Return the path relative to the folder, or None if it is not inside it."""
    try:
        return pathlib.Path(os.path.normpath(path)).relative_to(folder).as_posix()
    except ValueError:
        return None


# Each part of a CMake file, by the group that it matches: a call begins with its name.
_TOKEN = re.compile(
    r"#\[(?P<comment>=*)\[.*?\](?P=comment)\]|#[^\n]*|\[(?P<eq>=*)\[(?P<bracket>.*?)\](?P=eq)\]"
    r'|"(?P<quoted>(?:[^"\\]|\\.)*)"|(?P<call>\w+)\s*\(|(?P<paren>[()])|(?P<word>[^\s()"#]+)',
    re.DOTALL,
)


def parsed(text: str, file: str) -> list[Command]:
    """Return the Calls in a CMake file's text, as far as it can be read, with set() alone.

    catkin_lint's own reader says nothing at all of a file in which a parenthesis is missing.
    """
    calls: list[Command] = []
    variables: dict[str, str] = {}
    depth = 0
    for token in _TOKEN.finditer(text):
        kind, line = token.lastgroup, line_of(token)
        if kind in (None, "comment"):
            continue
        word = token[kind]
        # A call whose parenthesis is missing ends where a line below it begins with a call.
        if kind == "call" and (not depth or line > calls[-1].line and word.lower() in _CALLS):
            calls.append(Command(word.lower(), [], file, line))
            depth = 1
        elif depth:
            depth += {"call": 1, "paren": 1 if word == "(" else -1}.get(kind, 0)
            calls[-1].arguments.extend([word] if kind != "paren" else [])
    for command, arguments, *_ in calls:
        words = [_expanded(word, variables) for word in arguments]
        arguments[:] = [part for word in words for part in word.split(";") if part]
        if command == "set" and arguments:
            variables[arguments[0]] = ";".join(arguments[1:])
        if command == "project" and arguments:
            variables["PROJECT_NAME"] = arguments[0]
    return calls


def _expanded(text: str, variables: Mapping[str, str]) -> str:
    return re.sub(r"\$\{(\w+)\}", lambda m: variables.get(m.group(1), m.group(0)), text)


START = ""


def sections(arguments: Iterable[str], names: Collection[str]) -> dict[str, list[str]]:
    """Return keyword -> its arguments, for a call such as find_package(x REQUIRED COMPONENTS y);
    those before the first keyword are of START."""
    result: dict[str, list[str]] = {START: []}
    current = START
    for argument in arguments:
        if argument in names:
            current = argument
            result.setdefault(current, [])
        else:
            result[current].append(argument)
    return result


# Words that may stand among the sources of a target, but name no source.
_NO_SOURCES = set(
    (
        "WIN32 MACOSX_BUNDLE EXCLUDE_FROM_ALL STATIC SHARED MODULE OBJECT INTERFACE PUBLIC PRIVATE"
    ).split()
)


class Model:
    """What all calls of a package come to.

    complete: whether CMake went through all of it; if not, the rest is read as text
    output: what CMake and `make help` print
    made: all targets, those of ROS and of the messages, too; nothing if CMake failed
    project: (name, Command) or None
    components: ROS package -> Command, of find_package
    catkin: the Command of find_package(catkin ...), or None
    catkin_package: its Command, or None; late: the first executable before it, or None
    include_dirs: the folders in INCLUDE_DIRS of catkin_package()
    targets: name -> Target; scripts: list of Script
    message_files: name -> Command, of services and actions, too
    """

    def __init__(
        self,
        folder: pathlib.Path,
        calls: Iterable[Command],
        complete: bool,
        output: str = "",
    ) -> None:
        self.folder = pathlib.Path(folder)
        self.complete = complete
        self.made = set(re.findall(r"^\.\.\. (\S+)", output, re.MULTILINE))
        self.calls = list(calls)
        if not complete:
            self.calls += self._rest()
        self.project: tuple[str, Command] | None = None
        self.catkin: Command | None = None
        self.catkin_package: Command | None = None
        self.late: Target | None = None
        self.add_message_files: Command | None = None
        self.generate: Command | None = None
        self.components: dict[str, Command] = {}
        self.include_dirs: list[str] = []
        self.targets: dict[str, Target] = {}
        self.scripts: list[Script] = []
        self.message_files: dict[str, Command] = {}
        self.installs: list[Command] = []
        for call in self.calls:
            if call.arguments or call.command in _MAY_BE_EMPTY:
                _UNDERSTOOD.get(call.command, lambda model, call: None)(self, call)

    def _rest(self) -> list[Command]:
        """Return the calls that CMake did not come to."""
        path = self.folder / "CMakeLists.txt"
        try:
            text = written.read(path).decode("utf-8", "replace")
        except OSError:
            return []
        reached = max((c.line for c in self.calls if c.file == "CMakeLists.txt"), default=0)
        return [call for call in parsed(text, "CMakeLists.txt") if call.line > reached]

    def path(self, text: str, call: Command) -> str | None:
        """Return a path in a call, relative to the package; None if it is not inside it."""
        base = self.folder / pathlib.PurePosixPath(call.file).parent
        for folder in (base, self.folder):
            path = folder / text
            if path.exists():
                return relative(path, self.folder)
        return relative(base / text, self.folder)

    @property
    def finds_all(self) -> bool:
        """Whether catkin_simple finds what package.xml names, and makes the messages."""
        return self.catkin is not None and self.catkin.arguments[0] == "catkin_simple"

    def relayed(self) -> set[str]:
        """Return the scripts that catkin makes executables of."""
        return {script.path for script in self.scripts if script.by == "catkin_install_python"}

    def executables(self) -> dict[str, Target]:
        return {t.output or t.name: t for t in self.targets.values() if not t.is_library}

    def lacks_target(self, name: str) -> bool:
        """Return whether it is certain that there is no target of that name."""
        if self.complete:
            return bool(self.made) and name not in self.made and not re.search(r"[$:]", name)
        project = self.project[0] if self.project else ""
        own = rf"{re.escape(project)}_(gen(cpp|py)|generate_messages(_\w+)?)"
        return self.generate is None and bool(re.fullmatch(own, name))

    def linked(self, target: Target, seen: tuple[str, ...] = ()) -> list[Target]:
        """Return a target, and the package's libraries that it is linked with."""
        found = [target]
        for name in target.links:
            other = self.targets.get(name)
            if other is not None and name not in seen and other is not target:
                found += self.linked(other, (*seen, target.name))
        return found

    def all_sources(self, target: Target) -> list[str]:
        """Return the sources of a target, and of the package's libraries that it is linked with."""
        return list(dict.fromkeys(file for part in self.linked(target) for file in part.sources))

    def _project(self, call: Command) -> None:
        self.project = self.project or (call.arguments[0], call)

    def _find_package(self, call: Command) -> None:
        parts = sections(
            call.arguments, {"REQUIRED", "COMPONENTS", "QUIET", "OPTIONAL_COMPONENTS", "CONFIG"}
        )
        name = call.arguments[0]
        if name == "catkin_simple":  # it finds catkin, and calls catkin_package()
            self.catkin = self.catkin_package = call
        elif name == "catkin":
            self.catkin = self.catkin or call
            # find_package(catkin REQUIRED roscpp) means the same as with COMPONENTS.
            rest = parts[START][1:] + parts.get("REQUIRED", []) + parts.get("COMPONENTS", [])
            for component in rest:
                self.components.setdefault(component, call)
        else:
            self.components.setdefault(name, call)

    def _catkin_package(self, call: Command) -> None:
        if not self.catkin_package:  # a later call moves no executable
            made = (target for target in self.targets.values() if not target.is_library)
            self.late = next(made, None)
        self.catkin_package = self.catkin_package or call
        names = {
            *("INCLUDE_DIRS", "LIBRARIES", "CATKIN_DEPENDS", "DEPENDS", "CFG_EXTRAS"),
            *("EXPORTED_TARGETS", "SKIP_CMAKE_CONFIG_GENERATION"),
        }
        parts = sections(call.arguments, names)
        self.include_dirs = parts.get("INCLUDE_DIRS", [])

    def _add_executable(self, call: Command, is_library: bool = False) -> None:
        name, *sources = call.arguments
        if "ALIAS" in sources or "IMPORTED" in sources:
            return
        target = Target(name, call.file, call.line, is_library)
        self.targets[name] = target
        self._sources(target, sources, call)

    def _sources(self, target: Target, sources: Iterable[str], call: Command) -> None:
        for source in sources:
            if "$" in source or source in _NO_SOURCES:
                continue
            # CMake before 3.20 adds the ending itself (policy CMP0115).
            paths = (self.path(name, call) for name in (source, f"{source}.cpp"))
            path = next((path for path in paths if path and (self.folder / path).is_file()), None)
            if path is None:
                target.missing.append((self.path(source, call) or source, call.file, call.line))
            else:
                target.sources.append(path)

    def _add_library(self, call: Command) -> None:
        self._add_executable(call, is_library=True)

    def _target_sources(self, call: Command) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            self._sources(target, call.arguments[1:], call)

    def _target_link_libraries(self, call: Command) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            target.links += call.arguments[1:]
            target.link_line = call.line

    def _add_dependencies(self, call: Command) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            target.dependencies += call.arguments[1:]

    def _set_target_properties(self, call: Command) -> None:
        if "OUTPUT_NAME" in call.arguments[:-1] and "PROPERTIES" in call.arguments:
            output = call.arguments[call.arguments.index("OUTPUT_NAME") + 1]
            for name in call.arguments[: call.arguments.index("PROPERTIES")]:
                if name in self.targets:
                    self.targets[name].output = output

    def _catkin_install_python(self, call: Command) -> None:
        self._scripts(call, {"PROGRAMS", "DESTINATION", "OPTIONAL"})

    def _install(self, call: Command) -> None:
        self.installs.append(call)
        if call.arguments[0] == "PROGRAMS":
            names = {"PROGRAMS", "DESTINATION", "OPTIONAL", "PERMISSIONS", "RENAME", "COMPONENT"}
            self._scripts(call, names)

    def _scripts(self, call: Command, names: Collection[str]) -> None:
        for path in sections(call.arguments, names).get("PROGRAMS", []):
            script = self.path(path, call) or path
            self.scripts.append(Script(script, call.file, call.line, call.command))

    def _add_message_files(self, call: Command) -> None:
        self.add_message_files = self.add_message_files or call
        parts = sections(call.arguments, {"FILES", "DIRECTORY", "NOINSTALL", "PACKAGE"})
        ending = MESSAGES[call.command]
        folder = (parts.get("DIRECTORY") or [ending])[0]
        files = parts.get("FILES")
        if files is None:
            files = [path.name for path in (self.folder / folder).glob(f"*.{ending}")]
        for file in files:
            self.message_files[f"{folder}/{file}"] = call

    def _generate_messages(self, call: Command) -> None:
        self.generate = self.generate or call


# Command -> the ending of what it makes code of, which is the name of its folder, too.
MESSAGES = {"add_message_files": "msg", "add_service_files": "srv", "add_action_files": "action"}
_UNDERSTOOD = {
    "project": Model._project,
    "find_package": Model._find_package,
    "catkin_package": Model._catkin_package,
    "add_executable": Model._add_executable,
    "add_library": Model._add_library,
    "target_sources": Model._target_sources,
    "target_link_libraries": Model._target_link_libraries,
    "add_dependencies": Model._add_dependencies,
    "set_target_properties": Model._set_target_properties,
    "catkin_install_python": Model._catkin_install_python,
    "install": Model._install,
    **dict.fromkeys(MESSAGES, Model._add_message_files),
    "generate_messages": Model._generate_messages,
}
_MAY_BE_EMPTY = {"catkin_package", "generate_messages"}
_CALLS = {*_UNDERSTOOD, "include_directories"}
