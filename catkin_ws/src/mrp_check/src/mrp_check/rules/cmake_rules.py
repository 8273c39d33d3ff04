# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt: catkin's own calls, the targets' sources, the package's own messages."""

from __future__ import annotations

import difflib

from mrp_check.contract.finding import ERROR, WARNING, Finding
from mrp_check.contract.spec import PACKAGE
from mrp_check.rules.dependencies import last_dependency
from mrp_check.sources import uses
from mrp_check.student.manifest import declared

FILE = "CMakeLists.txt"


def missing():
    return Finding(
        "cmake",
        "The package has no CMakeLists.txt: catkin_make cannot build it.",
        expected="a file CMakeLists.txt beside package.xml",
        seen="none",
        fix="Write one, as the page on building shows.",
    )


def findings(package, model):
    """Yield findings about CMakeLists.txt, from a cmake.Model."""
    yield from _skeleton(package, model)
    yield from _sources(package, model)


def _skeleton(package, model):
    if model.project is None or model.catkin is None or model.catkin_package is None:
        for call, found, why in (
            ("project(NAME)", model.project, "CMake needs it first of all"),
            ("find_package(catkin REQUIRED ...)", model.catkin, "without it there is no catkin"),
            (
                "catkin_package()",
                model.catkin_package,
                "without it catkin does not know the package, and its executables are put where"
                " roslaunch and rosrun do not look",
            ),
        ):
            if found is None:
                before = model.catkin or (model.project and model.project[1])
                yield Finding(
                    "cmake",
                    f"CMakeLists.txt does not call {call}: {why}.",
                    FILE,
                    before.line if before else 1,
                    expected=call,
                    seen="no such call",
                    fix=f"Add {call} after this line." if before else f"Add {call}.",
                )
    if model.late is not None:
        yield Finding(
            "cmake",
            f"catkin_package() comes after the target {model.late.name} of line {model.late.line}:"
            " the executable is then put where roslaunch and rosrun do not look.",
            model.catkin_package.file,
            model.catkin_package.line,
            expected="catkin_package() before the first add_executable()",
            seen=f"{model.late.name} in line {model.late.line},"
            f" catkin_package() in line {model.catkin_package.line}",
            fix="Move catkin_package() up, to before the first target.",
        )


def _sources(package, model):
    for target in model.targets.values():
        for source, file, line in target.missing:
            near = difflib.get_close_matches(source, package.of_kind("cpp"), 1, 0.6)
            yield Finding(
                "targets",
                f"The target {target.name} is made of {source}, and there is no such file."
                + (f" Perhaps {near[0]} is meant." if near else ""),
                file,
                line,
                expected="the name of a file, relative to CMakeLists.txt",
                seen=source,
                fix=f"Write {near[0]} for {source}." if near else "Name a file that is there.",
            )


def own_messages(package, spec, model, manifest):
    """Yield findings about the messages of the package itself."""
    files = {path: path for path in package.of_kind("message") if path.count("/") <= 1}
    for name, fields in spec.messages.items():
        yield from _definition(package, name, fields)
    if not files and not model.message_files:
        return
    if not model.complete and model.catkin is None:
        return
    catkin_line = model.catkin.line if model.catkin else 1
    brings = {"message_generation", "genmsg"}  # the first is all of it; the second builds, too
    if not brings & {*model.components} and files and model.catkin:
        yield _message_finding(
            "find_package(catkin ...) does not name message_generation, which makes code of the"
            " package's own messages.",
            FILE,
            catkin_line,
            "find_package(catkin REQUIRED COMPONENTS message_generation ...)",
            "Add message_generation to COMPONENTS.",
        )
    needed = [path for path in files if path.rsplit("/", 1)[-1][:-4] in (spec.messages or files)]
    for path in files if not spec.messages else needed:
        if path not in model.message_files:
            call = model.add_message_files
            yield _message_finding(
                f"{path} is not named in add_message_files(): no code is made of it.",
                FILE,
                call.line if call else catkin_line,
                f"add_message_files(FILES {path.rsplit('/', 1)[-1]})",
                f"Add {path.rsplit('/', 1)[-1]} to add_message_files(FILES ...).",
            )
    if model.message_files and model.generate is None:
        yield _message_finding(
            "CMakeLists.txt never calls generate_messages(): no code is made of the messages.",
            FILE,
            model.add_message_files.line,
            "generate_messages(...) after add_message_files(...)",
            "Add generate_messages(DEPENDENCIES std_msgs).",
        )
    if manifest is not None:
        known = declared(manifest)
        for name, kind, tag in (
            ("message_generation", "build", "build_depend"),
            ("message_runtime", "exec", "exec_depend"),
        ):
            builds = kind == "build" and "genmsg" in known[kind]
            if name not in known[kind]:
                yield Finding(
                    "dependencies",
                    f"package.xml does not name {name} as a <{tag}>: the package has a message of"
                    " its own, and needs it.",
                    "package.xml",
                    last_dependency(package),
                    severity=WARNING if builds else ERROR,
                    expected=f"<{tag}>{name}</{tag}>",
                    seen=f"no <{tag}> with {name}",
                    fix=f"Add the line <{tag}>{name}</{tag}>.",
                )
    yield from _order(package, model)


def _message_finding(message, file, line, expected, fix):
    return Finding(
        "messages", message, file, line, expected=expected, seen="no such entry", fix=fix
    )


def _definition(package, name, fields):
    path = f"msg/{name}.msg"
    expected = "; ".join(f"{kind} {field}" for field, kind in fields.items())
    if path not in package.files:
        near = difflib.get_close_matches(path, package.of_kind("message"), 1, 0.6)
        yield Finding(
            "messages",
            f"There is no message {PACKAGE.lower()}/{name}: the file {path} is missing."
            + (f" There is {near[0]}." if near else ""),
            near[0] if near else None,
            1 if near else None,
            expected=f"{path} with: {expected}",
            seen=near[0] if near else "no such file",
            fix=f"Name the file {path}." if near else f"Write {path}.",
        )
        return
    seen = {}
    for number, text in enumerate(package.lines(path), 1):
        words = text.split("#")[0].split()
        if len(words) == 2 and "=" not in text:
            seen[words[1]] = (words[0], number)
    for field, kind in fields.items():
        if field not in seen or seen[field][0] != kind:
            near = difflib.get_close_matches(field, list(seen), 1, 0.5)
            number = seen[field][1] if field in seen else seen[near[0]][1] if near else 1
            yield Finding(
                "messages",
                f"The message {name} has no field '{kind} {field}'.",
                path,
                number,
                expected=f"{kind} {field}",
                seen=package.lines(path)[number - 1].strip() or "nothing",
                fix=f"Write the line: {kind} {field}",
            )


def _order(package, model):
    """Yield a finding for each target that uses a message's header before it is made."""
    own = {path.rsplit("/", 1)[-1][:-4] for path in package.of_kind("message")}
    for target in model.targets.values():
        used = [
            (file, line, header)
            for file in [*target.sources, *_headers(package, model, target)]
            if file in package.files
            for header, line in uses.includes(package, file)
            if header.split("/")[0] == package.name and header.split("/")[-1][:-2] in own
        ]
        waits = any(
            word.startswith(f"{package.name}_") and "gen" in word or "EXPORTED_TARGETS" in word
            for word in target.dependencies
        )
        if used and not waits and model.complete and model.generate is not None:
            file, line, header = used[0]
            yield Finding(
                "messages",
                f"The target {target.name} does not wait until {header}, which {file} includes in"
                f" line {line}, has been made. It then depends on chance whether it can be built.",
                target.file,
                target.line,
                expected=f"add_dependencies({target.name} ${{${{PROJECT_NAME}}_EXPORTED_TARGETS}})",
                seen="no such call",
                fix=f"Add add_dependencies({target.name} ${{${{PROJECT_NAME}}_EXPORTED_TARGETS}})"
                " after its add_executable().",
            )


def _headers(package, model, target):
    """Return the package's headers that a target's sources include, directly."""
    names = {
        header.rsplit("/", 1)[-1]
        for file in target.sources
        if file in package.files
        for header, _ in uses.includes(package, file)
    }
    return [path for path in package.of_kind("header") if path.rsplit("/", 1)[-1] in names]
