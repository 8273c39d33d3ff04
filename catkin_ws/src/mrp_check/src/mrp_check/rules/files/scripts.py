# SPDX-License-Identifier: BSD-3-Clause
"""Can each Python node be started: is it installed, is it executable, is its first line right?"""

from __future__ import annotations

import ast
import codecs
import dataclasses
import os
import shutil
from typing import Iterator

from mrp_check.build.catkin import search_path
from mrp_check.code import executables, python_modules, uses
from mrp_check.code.uses import is_test
from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding
from mrp_check.contract.names import last_part, nearest, perhaps
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.cmake import Model, Script
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

_MARKS = (codecs.BOM_UTF8, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
PYTHON = "python"  # what catkin_install_python replaces in the first line


def names_no_program(shebang: str) -> str | None:
    """Return the program that a first line names and this machine has not, or None."""
    words = shebang[2:].strip().split()
    if not words:
        return "nothing"
    if not words[0].startswith("/"):
        return words[0]
    if os.path.basename(words[0]) == "env":
        rest = [word for word in words[1:] if not word.startswith("-") and "=" not in word]
        program = rest[0] if rest else "nothing"
        return None if shutil.which(program, path=search_path()) else program
    return None if os.access(words[0], os.X_OK) and os.path.isfile(words[0]) else words[0]


def _findings(case: Case) -> Iterator[Finding]:
    package, model = case.package, case.model
    relayed = model.relayed()
    yield from _listed(package, model)
    # Without a contract, each node is a script, even one that Python cannot read.
    nodes = () if case.spec.is_contract else {node.file for node in case.spec.nodes.values()}
    for path in package.of_kind("python"):
        if is_test(path) or path == "setup.py":
            continue
        shebang = package.shebang(path) or ""
        is_node = path in case.started or path in nodes or path in {s.path for s in model.scripts}
        if is_node or shebang and _is_node(package, path):
            # What catkin_install_python() puts beside it starts it; once installed, nothing does.
            runs = path in relayed and not case.spec.is_contract
            for finding in _of(package, model, path, shebang, path in relayed):
                is_less = runs and finding.certainty not in (HABIT, HINT)
                yield dataclasses.replace(finding, certainty=HABIT) if is_less else finding
            yield from _shadowing(package, path)
        elif not case.spec.is_contract and executables.is_tool(package, path):
            for finding in _of(package, model, path, shebang, path in relayed):
                yield dataclasses.replace(finding, certainty=HABIT)


def _shadowing(package: Package, path: str) -> Iterator[Finding]:
    """Yield a finding if a script is found where a module that rospy, or it, imports is looked
    for."""
    name = last_part(path)
    stem, ending = os.path.splitext(name)
    is_package = any(f"/{file}".endswith(f"/{stem}/__init__.py") for file in package.files)
    own = (
        line
        for module, line in uses.imports(package, path)
        if module.startswith(f"{stem}.") or module == stem and is_package
    )
    is_rospys = python_modules.is_module(stem) and stem in python_modules.of_rospy()
    line, who = (1, "rospy") if is_rospys else (next(own, 0), "it")
    if ending == ".py" and line:
        yield Finding(
            "scripts",
            f"The script is called {name}, and {who} imports a module {stem}: Python looks first"
            " in the script's own folder, so it mistakes the script for the module.",
            path,
            line,
            expected="a name that no module has",
            seen=name,
            fix=f"Rename the script, to {stem}_node.py for example.",
            why="not-a-package",
        )


def _is_node(package: Package, path: str) -> bool:
    """Return whether a script calls rospy.init_node: others may be anything."""
    calls = (n.func for n in ast.walk(package.tree(path)) if isinstance(n, ast.Call))
    return "init_node" in {getattr(f, "attr", getattr(f, "id", "")) for f in calls}


def _listed(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a finding for each script that CMakeLists.txt names and that is not there."""
    for script in _not_there(package, model):
        near = nearest(script.path, package.of_kind("python"))
        yield Finding(
            "scripts",
            f"CMakeLists.txt installs {script.path}, but there's no such file." + perhaps(near),
            script.file,
            script.line,
            expected="the name of a file, relative to CMakeLists.txt",
            seen=script.path,
            fix=f"Write {near} for {script.path}." if near else "Name a file that exists.",
        )


_MODE = (
    "; roslaunch and rosrun start it anyway, because catkin_install_python() has created an"
    " executable for it.",
    ", so roslaunch and rosrun don't find it.",
)


def _of(
    package: Package, model: Model, path: str, shebang: str, relayed: bool
) -> Iterator[Finding]:
    plain = shebang.rstrip("\r")
    absent = names_no_program(plain) if plain else None
    if absent == PYTHON and not relayed:
        finding = _not_relayed(model, path, plain)
        finding.consequence_of = "scripts" if _is_misspelt(package, model, path) else None
        yield finding
    elif plain:
        yield from _other_program(path, plain, relayed, absent)
    # A byte order mark hides it: the rules about text say so.
    elif not package.bytes(path).startswith(_MARKS):
        yield _no_first_line(package, path)
    twins = [file for file in package.of_kind("python") if last_part(file) == last_part(path)]
    if not package.is_executable(path) and not any(map(package.is_executable, twins)):
        yield Finding(
            "scripts",
            f"{path} isn't executable{_MODE[0 if relayed else 1]}",
            path,
            1,
            certainty=HINT if relayed else CERTAIN,
            expected="permission to execute it",
            seen=f"mode {(package.root / path).stat().st_mode & 0o777:o}",
            fix=f"chmod +x {path}",
            why="script-not-executable",
        )


def _not_there(package: Package, model: Model) -> list[Script]:
    """Return the scripts that CMakeLists.txt names, and that are no files of the package."""
    missing = [script for script in model.scripts if script.path not in package.files]
    return [named for named in missing if "$" not in named.path and not named.path.startswith("/")]


def _is_misspelt(package: Package, model: Model, path: str) -> bool:
    """Return whether CMakeLists.txt names a script by a name like it, which no file has."""
    names = [script.path for script in _not_there(package, model)]
    return any(nearest(name, package.of_kind("python")) == path for name in names)


def _no_first_line(package: Package, path: str) -> Finding:
    lines = package.lines(path)[:20]
    hidden = next((n for n, text in enumerate(lines, 1) if text.startswith("#!")), None)
    return Finding(
        "scripts",
        f"{path} doesn't begin with #!, so Linux doesn't know to run it with Python."
        + (f" The #! is on line {hidden}, but has to be on the first." if hidden else ""),
        path,
        1,
        expected="#!/usr/bin/env python",
        seen=lines[0].strip() or "an empty line",
        fix="Make #!/usr/bin/env python the first line.",
        why="no-shebang",
    )


def _not_relayed(model: Model, path: str, plain: str) -> Finding:
    """Debian has no `python`: it takes catkin_install_python to put the right one there."""
    calls = [s for s in model.scripts if s.by == "catkin_install_python"]
    add = (
        f"Add {path} to catkin_install_python(PROGRAMS ...) on line {calls[0].line} of"
        f" {calls[0].file}."
        if calls
        else f"Add catkin_install_python(PROGRAMS {path} DESTINATION"
        " ${CATKIN_PACKAGE_BIN_DESTINATION}) to CMakeLists.txt; or write #!/usr/bin/env python3."
    )
    return Finding(
        "scripts",
        f"catkin_install_python() doesn't name {path}, and the script's first line asks for"
        " 'python', which this system doesn't have: it has python3.",
        path,
        1,
        expected="a line for it in catkin_install_python(PROGRAMS ...) of CMakeLists.txt",
        seen=plain,
        fix=add,
        why="no-python",
    )


def _other_program(path: str, plain: str, relayed: bool, absent: str | None) -> Iterator[Finding]:
    """Yield the finding about a first line that asks for the wrong program."""
    if absent and absent != PYTHON:
        what = f"names {absent}, a program that isn't there"
    elif "python" not in plain:
        what = "hands the Python script to another program"
    elif "python2" in plain:
        what = "asks for Python 2, which has no rospy here"
    else:
        return
    wanted = "#!/usr/bin/env python" + ("" if relayed else "3")
    yield Finding(
        "scripts",
        f"The first line of {path} {what}.",
        path,
        1,
        expected=wanted,
        seen=plain,
        fix=f"Make {wanted} the first line.",
        change=(plain, wanted),
        why="no-python",
    )


RULE = Rule(
    stage="files",
    needs=("model", "launch"),
    findings=_findings,
    requirements={
        "scripts": Requirement(
            "Each script is there, executable, and can be started",
            "wrong#the-script-is-not-executable",
            evidence.python,
        )
    },
)
