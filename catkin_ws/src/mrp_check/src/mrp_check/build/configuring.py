# SPDX-License-Identifier: BSD-3-Clause
"""Why CMake stops, as a finding: its first error, the line, and plain words."""

from __future__ import annotations

import pathlib
import re
from typing import Callable, Sequence, Tuple

from mrp_check.build.catkin import WANTS_TESTS, Step
from mrp_check.build.stubs import ALIKE, NOT_FOUND, PACKAGES
from mrp_check.code import uses
from mrp_check.contract import resources
from mrp_check.contract.finding import Finding
from mrp_check.contract.names import nearest, perhaps
from mrp_check.package.cmake import Model, relative
from mrp_check.package.package import Package

_Said = Tuple[str, str]  # what it means, and what to do

_CMAKE_ERROR = re.compile(
    r"^CMake Error(?: \(dev\))? (?:at|in) (?P<file>[^:\n]+?):(?P<line>\d+)"
    r"(?: \((?P<command>\w+)\))?:",
    re.MULTILINE,
)
_STACK = re.compile(r"^  (?P<file>[^:\s]+):(?P<line>\d+) \((?P<command>\w+)\)", re.MULTILINE)


def finding(package: Package, output: str, copy: pathlib.Path, model: Model) -> Finding | None:
    """Return the Finding about why CMake failed, or None if its output does not say it."""
    match = _CMAKE_ERROR.search(output)
    if not match:
        return None
    block = _block(output, match)
    file, line, command = _place(match, block, copy)
    text = " ".join(block.split("Call Stack")[0].replace(f"{copy}/", "").split())
    if file is None or file not in package.files:
        file, line = "CMakeLists.txt", 1
    undeclared = re.search(r"package '(\w+)' which must therefore be listed as a run dep", text)
    if undeclared:
        return _undeclared(package, undeclared.group(1), text)
    (meaning, fix), why = _in_words(package, text, command, model)
    # An unknown command stands where it is called: what defines it is missing further up.
    if (
        "Unknown CMake command" in text
        and model.catkin
        and any(f'"{command}"' in text for command in _BRINGS_MESSAGES)
    ):
        file, line = model.catkin.file, model.catkin.line
    line = max(1, min(line, len(package.lines(file))))
    return Finding(
        "configure",
        f"CMake stops at line {line} of {file}: {meaning}",
        file,
        line,
        expected="a CMakeLists.txt that CMake can follow",
        seen=f"{package.line(file, line)}  (CMake: {text[:300]})",
        fix=fix,
        why=why,
    )


def _block(output: str, error: re.Match[str]) -> str:
    """Return what CMake prints of an error, up to the next one."""
    rest = output[error.end() :]
    following = re.search(r"^CMake Error|^-- Configuring incomplete", rest, re.MULTILINE)
    return rest[: following.start()] if following else rest[:4000]


def _place(error: re.Match[str], block: str, copy: pathlib.Path) -> tuple[str | None, int, str]:
    """Return (file, line, command) of an error: those of the package that led to it, if any."""
    for place in (error, *_STACK.finditer(block)):
        file = _relative_any(place.group("file"), copy)
        if file is not None:
            return file, int(place.group("line")), place.group("command") or ""
    return None, 1, error.group("command") or ""


def _undeclared(package: Package, name: str, text: str) -> Finding:
    """Return the Finding about what catkin_package() names and package.xml lacks at run time."""
    line = package.find_line("package.xml", f">{name}<")
    return Finding(
        "configure",
        f"catkin_package() names {name}, but package.xml doesn't say that it's needed when the"
        " package runs.",
        "package.xml",
        line or package.find_line("package.xml", "depend>", 1),
        expected=f"<depend>{name}</depend>, which is for building and for running",
        seen=package.line("package.xml", line) if line else f"no {name}; CMake: {text}",
        fix=f"Write <depend>{name}</depend>.",
        why="catkin-package-depends",
    )


def _relative_any(path: str, copy: pathlib.Path) -> str | None:
    """Return a path that CMake prints (absolute, or relative to src) as the package's."""
    if path.startswith("/"):
        return relative(path, copy)
    return relative(str(copy.parent / path), copy)


_COMMANDS = (
    "cmake_minimum_required project find_package catkin_package include_directories add_executable"
    " add_dependencies target_link_libraries install catkin_install_python add_compile_options set"
    " add_message_files generate_messages catkin_python_setup add_library foreach endforeach"
    " if endif"
    " target_include_directories file function endfunction macro endmacro set_target_properties"
).split()


_MESSAGE_TARGETS = ["generate_messages", "generate_messages_cpp", "gencpp"]


_DEFINITION = r"Cannot locate message \[\w+\] in package \[(\w+)\]"


def without_definitions(output: str) -> str | None:
    """Return the package whose headers this machine has, and whose definitions it has not: Debian
    keeps them apart. None if CMake did not look for such a definition."""
    found = re.search(_DEFINITION, output)
    if not found or not uses.is_installed(found[1]):
        return None
    has_any = any((pathlib.Path(share) / found[1] / "msg").is_dir() for share in resources.SHARES)
    return None if has_any else found[1]


_BRINGS_MESSAGES = ("add_message_files", "generate_messages", "add_service_files")


def _unknown_command(package: Package, model: Model, match: re.Match[str], text: str) -> _Said:
    name = match.group(1)
    if name in _BRINGS_MESSAGES:
        return (
            f"{name}() isn't known, because find_package(catkin ...) doesn't name"
            " message_generation, which provides it.",
            "Add message_generation to COMPONENTS.",
        )
    if name.startswith("catkin_") and model.catkin is None:
        return (
            f"{name}() isn't known, because find_package(catkin REQUIRED ...) is missing above it.",
            "Add find_package(catkin REQUIRED COMPONENTS ...).",
        )
    near = nearest(name.lower(), _COMMANDS)
    meaning = f"there's no command {name}().{perhaps(near)}"
    return meaning, f"Write {near}." if near else "Correct it."


def _no_package(package: Package, model: Model, match: re.Match[str], text: str) -> _Said:
    name = match.group(1)
    near = nearest(name, PACKAGES, ALIKE)
    return (
        f"there's no package {name} on this machine.{perhaps(near)}",
        f"Write {near} for {name}." if near else f"Install {name}, or remove it.",
    )


def _no_target(package: Package, model: Model, match: re.Match[str], text: str) -> _Said:
    name = match.group(1)
    near = nearest(name, [] if name in model.targets else model.targets, 0.5)
    hint = f" There's {near}." if near else ""
    return (
        f"there's no target {name} at this point.{hint} add_executable() has to come before.",
        f"Write {near} for {name}." if near else f"Add add_executable({name} ...) above it.",
    )


def _no_dependency(package: Package, model: Model, match: re.Match[str], text: str) -> _Said:
    name = match.group(1)
    near = nearest(name, [*model.targets, *(f"{package.name}_{kind}" for kind in _MESSAGE_TARGETS)])
    return (
        f"there's no target {name} to wait for.{perhaps(near)}",
        f"Write {near} for {name}." if near else f"Remove {name}.",
    )


# (command or None for any, what CMake says) -> what it means and what to do: these words, or a
# function that says them; and the entry of the page why.
_WORDS: Sequence[tuple[str | None, str, Callable[..., _Said] | _Said, str]] = (
    (
        None,
        WANTS_TESTS,
        (
            "it builds a test even where no tests are wanted, such as when Debian builds a"
            " package.",
            "Put it between if(CATKIN_ENABLE_TESTING) and endif().",
        ),
        "",
    ),
    (None, r'Unknown CMake command "(\w+)"', _unknown_command, "cmake-unknown-command"),
    *(("find_package", shape, _no_package, "package-config-not-found") for shape in NOT_FOUND),
    (
        None,
        r"Messages depends on unknown pkg: (\w+)",
        (
            "generate_messages() names a package that find_package() doesn't find.",
            "Name only what the definitions use, and find it with find_package(catkin ...).",
        ),
        "",
    ),
    (
        None,
        r"Cannot locate message \[(\w+)\]: unknown package \[(\w+)\]",
        lambda *given: (
            f"a definition uses {given[2][2]}/{given[2][1]}, but generate_messages() doesn't name"
            f" {given[2][2]}.",
            f"Write generate_messages(DEPENDENCIES ... {given[2][2]}).",
        ),
        "",
    ),
    (
        "catkin_package",
        r"catkin_package\(\) .*?'(\w+)'",
        lambda *given: (
            given[-1],
            "Name the same packages in package.xml, find_package() and catkin_package().",
        ),
        "catkin-package-depends",
    ),
    (
        None,
        r'Cannot specify (?:link libraries|include directories|\w+ \w+) for target "(\S+)"',
        _no_target,
        "cmake-no-target",
    ),
    (
        None,
        r'add_dependencies Cannot add target-level dependencies to non-existent target "(\S+?)"',
        _no_target,
        "cmake-no-target",
    ),
    (
        "add_dependencies",
        r'The dependency target "(\S+)" of target "\S+" does not exist',
        _no_dependency,
        "cmake-no-target",
    ),
    (
        None,
        r"because another target with the same name already exists",
        ("there's already a target of this name, further up.", "Give it its own name."),
        "cmake-target-twice",
    ),
    (
        None,
        r"Parse error|Function missing ending|end of file|not closed",
        ("a bracket or a quotation mark is missing, or one too many.", "Correct the call there."),
        "cmake-parenthesis",
    ),
)


def _in_words(package: Package, text: str, command: str, model: Model) -> tuple[_Said, str]:
    """Return (what it means, what to do), and the entry of the page why."""
    for of_command, shape, words, why in _WORDS:
        match = re.search(shape, text) if of_command in (None, command) else None
        if match:
            advice = words if isinstance(words, tuple) else words(package, model, match, text)
            return advice, why
    return (text[:300], "Compare the line with the one on the page."), ""


def unknown(package: Package, step: Step, id_: str) -> Finding:
    """Return a Finding about a failure whose output names no place in the package."""
    lines = [line for line in step.output.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    what = "CMake" if id_ == "configure" else "catkin_make"
    if step.why_ended:
        message, seen = f"{what} was ended: {step.why_ended}.", step.why_ended
    else:
        message = f"{what} failed; what it printed names no line of the package."
        seen = " ".join((errors or lines)[-3:])[:500]
    return Finding(
        id_,
        message,
        "CMakeLists.txt" if "CMakeLists.txt" in package.files else None,
        1 if "CMakeLists.txt" in package.files else None,
        expected=f"{what} to succeed",
        seen=seen,
        fix="Run catkin_make yourself, and read what it prints from the top.",
    )
