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
from typing import Collection, Iterable, Mapping, Sequence, Tuple

from mrp_check.confined import written


class Call(typing.NamedTuple):
    command: str  # in lower case
    arguments: list[str]
    file: str  # relative to the package
    line: int


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


def traced(trace: pathlib.Path, package_folder: pathlib.Path) -> list[Call]:
    """Return the Calls in a file that CMake's --trace-format=json-v1 made, of the package alone."""
    calls: list[Call] = []
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
            calls.append(Call(entry["cmd"].lower(), arguments, file, entry["line"]))
    return calls


def relative(path: str | pathlib.Path, folder: pathlib.Path) -> str | None:
    """Return the path relative to the folder, or None if it is not inside it."""
    try:
        return pathlib.Path(os.path.normpath(path)).relative_to(folder).as_posix()
    except ValueError:
        return None


_Token = Tuple[str, int, bool]  # its text, its line, whether it is a parenthesis
_TOKEN = re.compile(
    r"#\[(?P<eq>=*)\[.*?\](?P=eq)\]|#[^\n]*|\[(?P<eq2>=*)\[(?P<bracket>.*?)\](?P=eq2)\]"
    r'|"(?P<quoted>(?:[^"\\]|\\.)*)"|(?P<paren>[()])|(?P<word>[^\s()"#]+)',
    re.DOTALL,
)


def parsed(text: str, file: str) -> list[Call]:
    """Return the Calls in a CMake file's text, as far as it can be read, with set() alone."""
    calls, tokens = [], []
    variables: dict[str, str] = {}
    for match in _TOKEN.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        if match.group("paren"):
            tokens.append((match.group("paren"), line, True))
        elif match.group("word") is not None:
            tokens.append((match.group("word"), line, False))
        elif match.group("quoted") is not None or match.group("bracket") is not None:
            tokens.append((match.group("quoted") or match.group("bracket") or "", line, False))
    index = 0
    while index + 1 < len(tokens):
        (name, line, is_paren), (after, _, _) = tokens[index], tokens[index + 1]
        if is_paren or after != "(" or not re.fullmatch(r"\w+", name):
            index += 1
            continue
        index, depth, arguments = index + 2, 1, []
        while index < len(tokens) and depth:
            word, _, paren = tokens[index]
            # A call whose parenthesis is missing ends where the next line begins with a call.
            if not paren and _begins_call(tokens, index, line):
                break
            depth += {"(": 1, ")": -1}.get(word, 0) if paren else 0
            if not paren:
                arguments.append(word)
            index += 1
        arguments = [part for a in arguments for part in _expanded(a, variables).split(";") if part]
        calls.append(Call(name.lower(), arguments, file, line))
        if name.lower() == "set" and arguments:
            variables[arguments[0]] = ";".join(arguments[1:])
        if name.lower() == "project" and arguments:
            variables["PROJECT_NAME"] = arguments[0]
    return calls


START = ""
_KNOWN = {
    "add_executable",
    "target_link_libraries",
    "catkin_package",
    "find_package",
    "install",
    "project",
    "catkin_install_python",
    "include_directories",
    "add_dependencies",
    "add_message_files",
    "generate_messages",
}


def _begins_call(tokens: Sequence[_Token], index: int, line: int) -> bool:
    word, number, _ = tokens[index]
    after = tokens[index + 1] if index + 1 < len(tokens) else ("", 0, False)
    return number > line and after[2] and after[0] == "(" and word.lower() in _KNOWN


def _expanded(text: str, variables: Mapping[str, str]) -> str:
    return re.sub(r"\$\{(\w+)\}", lambda m: variables.get(m.group(1), m.group(0)), text)


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


class Model:
    """What all calls of a package come to.

    complete: whether CMake went through all of it; if not, the rest is read as text
    project: (name, Call) or None
    components: ROS package -> Call, of find_package
    catkin: the Call of find_package(catkin ...), or None
    catkin_package: its Call, or None; late: the first target before it, or None
    depends: the packages in CATKIN_DEPENDS
    targets: name -> Target; scripts: list of Script; message_files: name -> Call
    """

    def __init__(self, folder: pathlib.Path, calls: Iterable[Call], complete: bool) -> None:
        self.folder = pathlib.Path(folder)
        self.complete = complete
        self.calls = list(calls)
        if not complete:
            self.calls += self._rest()
        self.project: tuple[str, Call] | None = None
        self.catkin: Call | None = None
        self.catkin_package: Call | None = None
        self.late: Target | None = None
        self.add_message_files: Call | None = None
        self.generate: Call | None = None
        self.components: dict[str, Call] = {}
        self.depends: list[str] = []
        self.targets: dict[str, Target] = {}
        self.scripts: list[Script] = []
        self.message_files: dict[str, Call] = {}
        self.installs: list[Call] = []
        for call in self.calls:
            if call.arguments or call.command in _MAY_BE_EMPTY:
                _UNDERSTOOD.get(call.command, lambda model, call: None)(self, call)

    def _rest(self) -> list[Call]:
        """Return the calls that CMake did not come to."""
        path = self.folder / "CMakeLists.txt"
        try:
            text = written.read(path).decode("utf-8", "replace")
        except OSError:
            return []
        reached = max((c.line for c in self.calls if c.file == "CMakeLists.txt"), default=0)
        return [call for call in parsed(text, "CMakeLists.txt") if call.line > reached]

    def path(self, text: str, call: Call) -> str | None:
        """Return a path in a call, relative to the package; None if it is not inside it."""
        base = self.folder / pathlib.PurePosixPath(call.file).parent
        for folder in (base, self.folder):
            path = folder / text
            if path.exists():
                return relative(path, self.folder)
        return relative(base / text, self.folder)

    def executables(self) -> dict[str, Target]:
        return {t.output or t.name: t for t in self.targets.values() if not t.is_library}

    def all_sources(self, target: Target, seen: tuple[str, ...] = ()) -> list[str]:
        """Return the sources of a target and of the package's libraries that it is linked with."""
        sources = list(target.sources)
        for name in target.links:
            other = self.targets.get(name)
            if other is not None and name not in seen and other is not target:
                sources += self.all_sources(other, (*seen, target.name))
        return list(dict.fromkeys(sources))

    def _project(self, call: Call) -> None:
        self.project = self.project or (call.arguments[0], call)

    def _find_package(self, call: Call) -> None:
        parts = sections(
            call.arguments, {"REQUIRED", "COMPONENTS", "QUIET", "OPTIONAL_COMPONENTS", "CONFIG"}
        )
        name = call.arguments[0]
        if name == "catkin":
            self.catkin = self.catkin or call
            # find_package(catkin REQUIRED roscpp) means the same as with COMPONENTS.
            rest = parts[START][1:] + parts.get("REQUIRED", []) + parts.get("COMPONENTS", [])
            for component in rest:
                self.components.setdefault(component, call)
        else:
            self.components.setdefault(name, call)

    def _catkin_package(self, call: Call) -> None:
        self.catkin_package = self.catkin_package or call
        if self.targets:
            self.late = next(iter(self.targets.values()))
        names = {
            *("INCLUDE_DIRS", "LIBRARIES", "CATKIN_DEPENDS", "DEPENDS", "CFG_EXTRAS"),
            *("EXPORTED_TARGETS", "SKIP_CMAKE_CONFIG_GENERATION"),
        }
        self.depends = sections(call.arguments, names).get("CATKIN_DEPENDS", [])

    def _add_executable(self, call: Call, is_library: bool = False) -> None:
        name, *sources = call.arguments
        if "ALIAS" in sources or "IMPORTED" in sources:
            return
        target = Target(name, call.file, call.line, is_library)
        self.targets[name] = target
        words = {
            "WIN32",
            "MACOSX_BUNDLE",
            "EXCLUDE_FROM_ALL",
            "STATIC",
            "SHARED",
            "MODULE",
            "OBJECT",
            "INTERFACE",
            "PUBLIC",
            "PRIVATE",
        }
        self._sources(target, [source for source in sources if source not in words], call)

    def _sources(self, target: Target, sources: Iterable[str], call: Call) -> None:
        for source in sources:
            if "$" in source:
                continue
            path = self.path(source, call)
            if path is None or not (self.folder / path).exists():
                target.missing.append((source, call.file, call.line))
            else:
                target.sources.append(path)

    def _add_library(self, call: Call) -> None:
        self._add_executable(call, is_library=True)

    def _target_sources(self, call: Call) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            rest = [a for a in call.arguments[1:] if a not in ("PUBLIC", "PRIVATE", "INTERFACE")]
            self._sources(target, rest, call)

    def _target_link_libraries(self, call: Call) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            target.links += call.arguments[1:]
            target.link_line = call.line

    def _add_dependencies(self, call: Call) -> None:
        target = self.targets.get(call.arguments[0])
        if target:
            target.dependencies += call.arguments[1:]

    def _set_target_properties(self, call: Call) -> None:
        if "OUTPUT_NAME" in call.arguments[:-1] and "PROPERTIES" in call.arguments:
            output = call.arguments[call.arguments.index("OUTPUT_NAME") + 1]
            for name in call.arguments[: call.arguments.index("PROPERTIES")]:
                if name in self.targets:
                    self.targets[name].output = output

    def _catkin_install_python(self, call: Call) -> None:
        programs = sections(call.arguments, {"PROGRAMS", "DESTINATION", "OPTIONAL"})
        for path in programs.get("PROGRAMS", []):
            self.scripts.append(
                Script(self.path(path, call) or path, call.file, call.line, "catkin_install_python")
            )

    def _install(self, call: Call) -> None:
        self.installs.append(call)
        if call.arguments[0] == "PROGRAMS":
            names = {"PROGRAMS", "DESTINATION", "OPTIONAL", "PERMISSIONS", "RENAME", "COMPONENT"}
            for path in sections(call.arguments, names)["PROGRAMS"]:
                self.scripts.append(
                    Script(self.path(path, call) or path, call.file, call.line, "install")
                )

    def _add_message_files(self, call: Call) -> None:
        self.add_message_files = self.add_message_files or call
        parts = sections(call.arguments, {"FILES", "DIRECTORY", "NOINSTALL", "PACKAGE"})
        folder = (parts.get("DIRECTORY") or ["msg"])[0]
        files = parts.get("FILES")
        if files is None:
            files = [path.name for path in (self.folder / folder).glob("*.msg")]
        for file in files:
            self.message_files[f"{folder}/{file}"] = call

    def _generate_messages(self, call: Call) -> None:
        self.generate = self.generate or call


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
    "add_message_files": Model._add_message_files,
    "generate_messages": Model._generate_messages,
}
_MAY_BE_EMPTY = {"catkin_package", "generate_messages"}
