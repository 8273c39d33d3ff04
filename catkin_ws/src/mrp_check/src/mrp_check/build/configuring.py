# SPDX-License-Identifier: BSD-3-Clause
"""Why CMake stops, as a finding: its first error, the line, and plain words."""

from __future__ import annotations

import difflib
import re

from mrp_check.contract.finding import Finding
from mrp_check.student.cmake import relative

_CMAKE_ERROR = re.compile(
    r"^CMake Error(?: \(dev\))? (?:at|in) (?P<file>[^:\n]+?):(?P<line>\d+)"
    r"(?: \((?P<command>\w+)\))?:",
    re.MULTILINE,
)
_STACK = re.compile(r"^  (?P<file>[^:\s]+):(?P<line>\d+) \((?P<command>\w+)\)", re.MULTILINE)


def finding(package, output, copy, model):
    """Return the Finding about why CMake failed, or None if its output does not say it."""
    match = _CMAKE_ERROR.search(output)
    if not match:
        return None
    rest = output[match.end() :]
    following = re.search(r"^CMake Error|^-- Configuring incomplete", rest, re.MULTILINE)
    block = rest[: following.start()] if following else rest[:4000]
    file, line = _relative_any(match.group("file"), copy), int(match.group("line"))
    command = match.group("command") or ""
    if file is None:
        for caller in _STACK.finditer(block):
            own = _relative_any(caller.group("file"), copy)
            if own:
                file, line, command = own, int(caller.group("line")), caller.group("command")
                break
    text = " ".join(block.split("Call Stack")[0].split())
    if file is None or file not in package.files:
        file, line = "CMakeLists.txt", 1
    undeclared = re.search(r"package '(\w+)' which must therefore be listed as a run dep", text)
    if undeclared:
        return _undeclared(package, undeclared.group(1), text)
    said, fix = _in_words(package, text, command, model)
    # An unknown command stands where it is called: what defines it is missing further up.
    if (
        "Unknown CMake command" in text
        and model.catkin
        and re.search(r'"(add_message_files|generate_messages|add_service_files)"', text)
    ):
        file, line = model.catkin.file, model.catkin.line
    line = max(1, min(line, len(package.lines(file))))
    return Finding(
        "configure",
        f"CMake stops at line {line} of {file}: {said}",
        file,
        line,
        expected="a CMakeLists.txt that CMake can follow",
        seen=f"{package.lines(file)[line - 1].strip()}  (CMake: {text[:300]})",
        fix=fix,
    )


def _undeclared(package, name, text):
    """Return the Finding about what catkin_package() names and package.xml lacks at run time."""
    line = package.find_line("package.xml", f">{name}<")
    return Finding(
        "configure",
        f"catkin_package() names {name}, and package.xml does not say that it is needed when the"
        " package runs.",
        "package.xml",
        line or package.find_line("package.xml", "depend>", 1),
        expected=f"<depend>{name}</depend>, which is for building and for running",
        seen=package.lines("package.xml")[line - 1].strip()
        if line
        else f"no {name}; CMake: {text}",
        fix=f"Write <depend>{name}</depend>.",
    )


def _relative_any(path, copy):
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


_PACKAGES = ["roscpp", "rospy", "std_msgs", "catkin", "message_generation", "roslib"]


def _not_found(text):
    """Return the match whose group is the name of a package that CMake did not find, or None."""
    return (
        re.search(r'Could not find a package configuration file provided by "(\w+)"', text)
        or re.search(r"catkin_package\(\).*?on the catkin package '(\w+)'", text)
        or re.search(r"Could NOT find (\w+)", text)
    )


def absent(package, output):
    """Return the package that CMake did not find though package.xml asks for it, and that looks
    like no other's misspelt name; or None."""
    match = _not_found(output)
    name = match and match.group(1)
    asked = name and package.find_line("package.xml", f">{name}<")
    return name if asked and not difflib.get_close_matches(name, _PACKAGES, 1, 0.6) else None


def _in_words(package, text, command, model):
    """Return (what it means, what to do)."""
    match = re.search(r'Unknown CMake command "(\w+)"', text)
    if match:
        name = match.group(1)
        if name in ("add_message_files", "generate_messages", "add_service_files"):
            return (
                f"{name}() is not known, as find_package(catkin ...) does not name"
                " message_generation, which brings it.",
                "Add message_generation to COMPONENTS.",
            )
        if name.startswith("catkin_") and model.catkin is None:
            return (
                f"{name}() is not known, as find_package(catkin REQUIRED ...) is missing above it.",
                "Add find_package(catkin REQUIRED COMPONENTS ...).",
            )
        near = difflib.get_close_matches(name.lower(), _COMMANDS, 1, 0.6)
        hint = f" Perhaps {near[0]} is meant." if near else ""
        return f"there is no command {name}().{hint}", f"Write {near[0]}." if near else "Mend it."
    match = _not_found(text)
    if match and command == "find_package":
        name = match.group(1)
        near = difflib.get_close_matches(name, _PACKAGES, 1, 0.6)
        hint = f" Perhaps {near[0]} is meant." if near else ""
        return (
            f"there is no package {name} on this machine.{hint}",
            f"Write {near[0]} for {name}." if near else f"Install {name}, or take it out.",
        )
    match = re.search(r"catkin_package\(\) .*?'(\w+)'", text)
    if command == "catkin_package" and match:
        return f"{text}", "Let package.xml, find_package() and catkin_package() name the same."
    match = re.search(r"Cannot find source file: (\S+)", text)
    if match:
        near = difflib.get_close_matches(match.group(1), package.of_kind("cpp"), 1, 0.6)
        hint = f" Perhaps {near[0]} is meant." if near else ""
        return f"there is no source {match.group(1)}.{hint}", "Name a file that is there."
    match = re.search(
        r'Cannot specify (?:link libraries|include directories|\w+ \w+) for target "(\S+)"', text
    ) or re.search(
        r"add_dependencies Cannot add target-level dependencies to"
        r' non-existent target "(\S+?)"',
        text,
    )
    if match:
        name = match.group(1)
        targets = [] if name in model.targets else list(model.targets)
        near = difflib.get_close_matches(name, targets, 1, 0.5)
        hint = f" There is {near[0]}." if near else ""
        return (
            f"there is no target {name} at this point.{hint} add_executable() has to come before.",
            f"Write {near[0]} for {name}." if near else f"Add add_executable({name} ...) above it.",
        )
    match = re.search(r"because another target with the same name already exists", text)
    if match:
        return "a target of this name has been made already, further up.", "Give it its own name."
    match = re.search(r"non-existing file '([^']+)'", text)
    if match:
        name = match.group(1).rsplit("/", 2)
        shown = "/".join(name[1:])
        near = difflib.get_close_matches(shown, package.of_kind("python"), 1, 0.6)
        hint = f" Perhaps {near[0]} is meant." if near else ""
        return f"there is no script {shown}.{hint}", "Name a file that is there."
    if "Function missing ending" in text:
        return "the call that begins there has no closing parenthesis.", "Close it with a )."
    if "end of file" in text or "not closed" in text:
        return (
            "a bracket or a quotation mark that is opened there is never closed.",
            "Close what was opened.",
        )
    if "Parse error" in text:
        return "a bracket or a quotation mark is missing, or too much.", "Mend the call there."
    return text[:300], "Compare the line with the one on the page."


def unknown(package, step, id_):
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
