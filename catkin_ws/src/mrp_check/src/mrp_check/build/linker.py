# SPDX-License-Identifier: BSD-3-Clause
"""What the linker prints, as findings: a target, what it lacks, and plain words."""

from __future__ import annotations

import re

from mrp_check.contract.finding import Finding

_UNDEFINED = re.compile(
    r"(?P<object>[\w./+-]+\.(?:cpp|cc|cxx|c\+\+|C)(?:\.o)?)[:)].*?"
    r"undefined reference to [`'‘](?P<name>.+?)['’]$"
)
_DUPLICATE = re.compile(r"multiple definition of [`'‘](?P<name>.+?)['’]")
_TARGET = re.compile(r"CMakeFiles/(?P<target>[^/]+)\.dir/")
_NO_MAIN = re.compile(r"undefined reference to [`'‘]main['’]")
_NO_LIBRARY = re.compile(r"cannot find -l(\S+)")


def findings(package, output, model):
    """Yield a finding for each target that cannot be linked."""
    said = set()
    target = None
    for line in output.splitlines():
        named = _TARGET.search(line)
        target = named.group("target") if named else target
        if target in said or target not in model.targets:
            continue
        one = model.targets[target]
        undefined = _UNDEFINED.search(line)
        if _NO_MAIN.search(line):
            said.add(target)
            where = (one.file, one.line)
            yield _link(
                f"The target {target} has no function main: none of its sources"
                f" ({', '.join(one.sources)}) defines one.",
                where,
                "one source with int main(...)",
                ", ".join(one.sources),
                "Add the source that has main, or write main.",
            )
        elif undefined:
            said.add(target)
            yield _undefined(package, one, undefined.group("name"), model)
        elif _DUPLICATE.search(line):
            said.add(target)
            name = _DUPLICATE.search(line).group("name")
            yield _link(
                f"The target {target} has two definitions of {name}: two of its sources define it.",
                (one.file, one.line),
                f"one definition of {name}",
                ", ".join(one.sources),
                "Give each target its own sources alone.",
            )
        elif _NO_LIBRARY.search(line):
            said.add(target)
            name = _NO_LIBRARY.search(line).group(1)
            yield _link(
                f"The target {target} is linked with {name}, and there is no such library.",
                (one.file, one.link_line or one.line),
                "${catkin_LIBRARIES}",
                name,
                f"Mend the name {name}.",
            )


def _undefined(package, target, name, model):
    is_ros = (
        name.startswith(("ros::", "std_msgs::", "boost::", "typeinfo for ros")) or "ros::" in name
    )
    if is_ros:
        linked = any("roscpp" in word for word in target.links)
        why = (
            f"it is not linked with ROS's libraries: target_link_libraries({target.name} ...) "
            + ("is missing." if target.link_line is None else "has no ${catkin_LIBRARIES}.")
            if not linked
            else "one of ROS's libraries is missing."
        )
        if target.link_line is not None and not linked and "roscpp" not in model.components:
            why = "find_package(catkin ...) does not name roscpp, so catkin_LIBRARIES lacks it."
        return _link(
            f"The target {target.name} cannot be linked: {name} is not found, as {why}",
            (target.file, target.link_line or target.line),
            f"target_link_libraries({target.name} ${{catkin_LIBRARIES}})",
            "no such call"
            if target.link_line is None
            else f"linked with: {' '.join(target.links)[:200]}",
            f"Add target_link_libraries({target.name} ${{catkin_LIBRARIES}}).",
        )
    function = name.split("(")[0]
    simple = function.split("::")[-1]
    for file in target.sources:
        if file not in package.files:
            continue
        line = package.find_line(file, f"{simple}(")
        if line:
            return _link(
                f"{name} is declared and called in the target {target.name}, and defined nowhere in"
                " its sources.",
                (file, line),
                f"a definition of {function}",
                package.lines(file)[line - 1].strip(),
                f"Define {function}, or mend its name where it is defined; or add its source to"
                f" add_executable({target.name} ...).",
            )
    return _link(
        f"The target {target.name} cannot be linked: {name} is defined in none of its sources.",
        (target.file, target.line),
        f"a definition of {function}",
        ", ".join(target.sources),
        "Add the source that defines it.",
    )


def _link(message, place, expected, seen, fix):
    return Finding("link", message, *place, expected=expected, seen=seen, fix=fix)
