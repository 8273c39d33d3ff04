# SPDX-License-Identifier: BSD-3-Clause
"""The package's own messages: their definitions, and what makes code of them."""

from __future__ import annotations

import pathlib
import re
from typing import Iterator, Mapping

import genmsg
from catkin_pkg.package import Package as Manifest
from genmsg.msg_loader import load_msg_from_string
from genmsg.msgs import BUILTIN_TYPES, bare_msg_type

from mrp_check.code import uses
from mrp_check.contract import resources
from mrp_check.contract.finding import CERTAIN, HABIT, READ, Finding
from mrp_check.contract.names import last_part, nearest, perhaps
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.spec import PACKAGE
from mrp_check.package.cmake import Model, Target
from mrp_check.package.manifest import declared, first_dependency
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

FILE = "CMakeLists.txt"


def _findings(case: Case) -> Iterator[Finding]:
    package, model, (manifest, _) = case.package, case.model, case.manifest
    for name, fields in case.spec.messages.items():
        yield from _definition(package, f"msg/{name}.msg", fields)
    for service in case.spec.services.values():
        path = f"srv/{service.type.split('/')[1]}.srv"
        for half, expected in enumerate((service.request, service.response)):
            yield from _definition(package, path, expected, half) if expected else ()
    files = [path for path in package.of_kind(*uses.DEFINITIONS) if path.count("/") <= 1]
    if not case.spec.is_contract:
        yield from definitions(case)
    asked = [path for path in files if path in model.message_files or _is_used(case, path)]
    made = model.message_files or model.generate
    if not files and not made or not model.complete and model.catkin is None:
        return
    if not model.finds_all:
        yield from _in_cmake(case, files)
    if manifest and (asked or model.message_files):
        # Another package brings what makes messages, as actionlib_msgs does.
        is_brought = model.complete and "message_generation" not in model.components
        yield from _in_manifest(package, manifest, is_brought)
    yield from _order(package, model)


def _in_cmake(case: Case, files: list[str]) -> Iterator[Finding]:
    """Yield a finding for each call of CMakeLists.txt that lacks, or lacks something. Where
    message_generation isn't found, CMake says so."""
    model = case.model
    own = {*case.spec.messages, *(s.type.split("/")[1] for s in case.spec.services.values())}
    catkin_line, call = model.catkin.line if model.catkin else 1, model.add_message_files
    for path in files:
        file = last_part(path)
        is_made = path in model.message_files or _is_of_action(path, model)
        if not is_made and (not own or file[:-4] in own):
            command = f"add_{case.package.kind(path)}_files"
            named = (other for other in model.message_files if last_part(other) == file)
            elsewhere = next((other for other in named if other not in case.package.files), None)
            if elsewhere:
                yield Finding(
                    "messages",
                    f"{command}() looks for {elsewhere}, but the file is at {path}, so CMake"
                    " stops.",
                    FILE,
                    model.message_files[elsewhere].line,
                    CERTAIN,
                    expected=elsewhere,
                    seen=path,
                    fix=f"Move {path} to {elsewhere}.",
                )
                continue
            yield _message_finding(
                f"{path} isn't named in {command}(), so no code is generated from it.",
                call.line if call else catkin_line,
                f"{command}(FILES {file})",
                f"Add {file} to {command}(FILES ...).",
                READ if _is_used(case, path) else HABIT,
            )
    if call and model.message_files and model.generate is None:
        yield _message_finding(
            "CMakeLists.txt never calls generate_messages(), so no code is generated from the"
            " messages.",
            call.line,
            f"generate_messages(...) after {call.command}(...)",
            "Add generate_messages(DEPENDENCIES std_msgs).",
        )


def _is_used(case: Case, path: str) -> bool:
    """Return whether a source that is built, a header, a file in Python or another definition names
    what is made of a definition; with a contract, each one is used."""
    package, targets = case.package, case.model.targets.values()
    built = {file for target in targets for file in target.sources if file in package.files}
    built = built if targets else {*package.of_kind("cpp")}
    others = package.of_kind("header", "python", *uses.DEFINITIONS)
    files = {*built, *others} - {path}
    names = rf"\b(?:{'|'.join(map(re.escape, uses.generated(path)))})\b"
    return case.spec.is_contract or any(
        re.search(names, uses.code(package, file)) for file in files
    )


def _is_of_action(path: str, model: Model) -> bool:
    """Return whether a message is one that an action is made into: code is made of it."""
    actions = (file for file in model.message_files if file.endswith(".action"))
    made = {name for action in actions for name in uses.generated(action)}
    return path.endswith(".msg") and last_part(path)[: -len(".msg")] in made


def _in_manifest(package: Package, manifest: Manifest, is_brought: bool) -> Iterator[Finding]:
    """Yield a finding for each package that makes or runs messages, and is not declared."""
    known = declared(manifest)
    for name, kind, tag in (
        ("message_generation", "build", "build_depend"),
        ("message_runtime", "exec", "exec_depend"),
    ):
        if kind == "exec" and manifest.package_format < 2:
            tag = "run_depend"
        if name not in known[kind]:
            yield Finding(
                "dependencies",
                f"package.xml doesn't name {name} as a <{tag}>, which the package needs for its"
                " own messages.",
                "package.xml",
                first_dependency(package, tag),
                # message_runtime is asked for where the package is installed: no build needs it.
                certainty=HABIT if is_brought or kind == "exec" else READ,
                expected=f"<{tag}>{name}</{tag}>",
                seen=f"no <{tag}> with {name}",
                fix=f"Add the line <{tag}>{name}</{tag}>.",
                packages=(name,),
            )


def _message_finding(
    message: str, line: int, expected: str, fix: str, certainty: str = READ
) -> Finding:
    seen = "no such entry"
    return Finding("messages", message, FILE, line, certainty, expected, seen, fix)


def _definition(
    package: Package, path: str, fields: Mapping[str, str], half: int = 0
) -> Iterator[Finding]:
    """Yield a finding for each field that a message lacks, or that half of a service."""
    kind = "service" if path.endswith(".srv") else "message"
    name = last_part(path)[:-4]
    expected = "; ".join(f"{type_} {field}" for field, type_ in fields.items())
    if path not in package.files:
        near = nearest(path, package.of_kind(kind))
        yield Finding(
            "messages",
            f"There's no {kind} {PACKAGE.lower()}/{name}: the file {path} is missing."
            + (f" There's {near}." if near else ""),
            near if near else None,
            1 if near else None,
            expected=f"{path} with: {expected}",
            seen=near if near else "no such file",
            fix=f"Name the file {path}." if near else f"Write {path}.",
        )
        return
    seen, part = {}, 0
    for number, text in enumerate(package.lines(path), 1):
        part += text.startswith("---")
        words = text.split("#")[0].split()
        if part == half and len(words) == 2 and "=" not in text:
            seen[words[1]] = (words[0], number)
    for field, type_ in fields.items():
        if field not in seen or seen[field][0] != type_:
            near = nearest(field, seen, 0.5)
            number = seen[field][1] if field in seen else seen[near][1] if near else 1
            yield Finding(
                "messages",
                f"The {kind} {name} has no field '{type_} {field}'.",
                path,
                number,
                expected=f"{type_} {field}",
                seen=package.line(path, number) or "nothing",
                fix=f"Write the line: {type_} {field}",
            )


def _order(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding for each target that uses a message's header before it is made."""
    own = uses.made(package)
    for target in model.targets.values():
        used = [
            include
            for include in _included(package, model, target)
            if include[2].split("/")[0] == package.name and last_part(include[2])[:-2] in own
        ]
        # CMake builds a library, and what that waits for, before what is linked with it.
        awaited = [word for part in model.linked(target) for word in part.dependencies]
        waits = any(_is_made(package, model, word) for word in awaited)
        if used and not waits and _knows_what_waits(model) and model.generate is not None:
            file, line, header = used[0]
            yield Finding(
                "messages",
                f"The target {target.name} doesn't wait until {header} is generated, but {file}"
                f" includes it on line {line}. So whether it can be built is a matter of luck.",
                target.file,
                target.line,
                CERTAIN,
                expected=f"add_dependencies({target.name} ${{${{PROJECT_NAME}}_EXPORTED_TARGETS}})",
                seen="no such call",
                fix=f"Add add_dependencies({target.name} ${{${{PROJECT_NAME}}_EXPORTED_TARGETS}})"
                " after its add_executable().",
            )


def _included(package: Package, model: Model, target: Target) -> list[tuple[str, int, str]]:
    """Return (file, line, header) of what a target's own files include."""
    files = [*target.sources, *_headers(package, model, target)]
    return [
        (file, line, header)
        for file in files
        if file in package.files
        for header, line in uses.includes(package, file)
    ]


def _is_made(package: Package, model: Model, word: str) -> bool:
    """Return whether what a target waits for makes the package's messages."""
    makes = word.startswith(f"{package.name}_") and "gen" in word or "EXPORTED_TARGETS" in word
    return makes and not model.lacks_target(word)


def _knows_what_waits(model: Model) -> bool:
    calls = [call for call in model.calls if call.command == "add_dependencies"]
    return model.complete or not any("$" in call.arguments[0] for call in calls)


def _headers(package: Package, model: Model, target: Target) -> list[str]:
    """Return the package's headers that a target's sources include, directly."""
    names = {
        last_part(header)
        for file in target.sources
        if file in package.files
        for header, _ in uses.includes(package, file)
    }
    return [path for path in package.of_kind("header") if last_part(path) in names]


_BETWEEN = "---"  # a request and its response
# Types of C++ and Python.
_OF_LANGUAGES = {"int": "int32", "float": "float32", "double": "float64", "str": "string"}


def definitions(case: Case) -> Iterator[Finding]:
    package, context = case.package, genmsg.MsgContext.create_default()
    for path in sorted({*package.of_kind(*uses.DEFINITIONS)} & {*case.model.message_files}):
        for line, text in enumerate(package.lines(path), 1):
            if not text.startswith(_BETWEEN):
                yield from _of_line(package, context, path, line, text)


def _of_line(
    package: Package, context: genmsg.MsgContext, path: str, line: int, text: str
) -> Iterator[Finding]:
    """Yield a Finding if a line is no field, no constant and no comment, or its type is nowhere."""
    try:
        spec = load_msg_from_string(context, text, f"{package.name}/A")
    except genmsg.InvalidMsgSpec as error:
        reason, expected = f"{error}", "a type and a name, such as int32 count"
    else:
        unknown = next(filter(None, (_unknown(package, type_) for type_ in spec.types)), None)
        if unknown is None:
            return
        reason, near = unknown
        expected = near or "a message type that exists"
    yield Finding(
        "messages",
        f"{path} has a line that ROS can't read: {reason}",
        path,
        line,
        CERTAIN,
        expected=expected,
        seen=text.strip(),
        fix="Write it as https://wiki.ros.org/msg says.",
    )


def _unknown(package: Package, type_: str) -> tuple[str, str | None] | None:
    """Return what to say of a type that is nowhere, and which is like it; None if it is there, or
    its package is not on this machine."""
    owner, _, name = bare_msg_type(type_).rpartition("/")
    if not owner:
        return None
    if owner == package.name:
        made = package.of_kind("message", "action")
        known = {other for path in made for other in uses.generated(path)}
        near = _OF_LANGUAGES.get(name) or nearest(name, [*BUILTIN_TYPES, *known])
        reason = f"there's no type {name}, and no msg/{name}.msg."
    else:
        folders = [pathlib.Path(share, owner, "msg") for share in resources.SHARES]
        known = {path.stem for folder in folders for path in folder.glob("*.msg")}
        near = nearest(name, known)
        reason = f"{owner} has no message {name}."
    if not known and owner != package.name or name in known:
        return None
    return reason + perhaps(near), near


RULE = Rule(
    stage="files",
    needs=("manifest", "model"),
    findings=_findings,
    requirements={
        "messages": Requirement(
            "The package's own messages are generated", "message_types", evidence.cmake
        )
    },
    also=("dependencies",),
    sure=READ,
)
