# SPDX-License-Identifier: BSD-3-Clause
"""Python can read each source, and what it names is there: modules, names, members."""

from __future__ import annotations

import ast
import builtins
import re
import sys
from typing import Collection, Iterator

from pyflakes import checker, messages

from mrp_check import releases
from mrp_check.code import uses
from mrp_check.code.python_facts import Definition, is_unused, last_line
from mrp_check.code.python_modules import (
    OF_PYTHON_2,
    is_known,
    is_module,
    is_ros,
    load,
    resolve,
    ros_modules,
)
from mrp_check.code.python_rule import PythonRule, of_sources
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import CERTAIN, HABIT, READ, Finding
from mrp_check.contract.names import last_part, nearest, perhaps
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

# Names of Python 2 -> what Python 3 has for them.
_PYTHON2 = {
    **{"unicode": "str", "xrange": "range", "raw_input": "input", "long": "int"},
    **{"basestring": "str", "reduce": "functools.reduce", "unichr": "chr", "file": "open"},
}
# By these, a source may give a value to names that it doesn't write.
_HIDES = {"builtins", "exec", "globals", "vars"}


class Names(PythonRule):
    def __init__(self, package: Package, source: Source) -> None:
        super().__init__(package, source)
        self.not_imported: list[str] = []  # names whose import fails
        self.message_names = {last_part(path)[:-4] for path in package.of_kind("message")}

    def findings(self) -> Iterator[Finding]:
        yield from [*self.imports()]
        yield from self.undefined_names()
        yield from self.attributes()

    def imports(self) -> Iterator[Finding]:
        for node in self.source.import_nodes:
            if self.source.is_guarded(node, "ImportError", "ModuleNotFoundError"):
                continue
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield from self._module(node, alias.name)
            elif not node.level and node.module:
                problem = list(self._module(node, node.module))
                yield from problem or self._imported(node, node.module)

    def _module(self, node: ast.stmt, name: str) -> Iterator[Finding]:
        if self.is_own(name):
            return
        missing, parent = None, None
        for length in range(1, name.count(".") + 2):
            part = ".".join(name.split(".")[:length])
            # Only ROS's own packages are imported: importing runs what is imported.
            if length > 1 and not is_ros(part):
                break
            if not is_module(part):
                missing = part
                break
            parent = part
        if missing is None:
            return
        self.not_imported.append(name.split(".")[-1])
        if uses.is_sibling(self.package, missing.split(".")[0]):
            return  # it is built with the package: the run shows whether it has that
        renamed, gone = OF_PYTHON_2.get(missing), releases.GONE.get(missing)
        if renamed or gone:
            reason = f"{missing} is the Python 2 name of a module that Python 3 calls {renamed}"
            if gone:
                reason = f"From Debian {gone.since} on, there's no {gone.what}"
            instead = gone.instead if gone else renamed
            yield self.finding(
                "python-names",
                f"{reason}: Python raises a ModuleNotFoundError.",
                node,
                expected=instead,
                fix=f"Use {instead}.",
                why=gone.why if gone else "",
            )
            return
        if parent is None:
            known = set(sys.modules) | ros_modules()
            # Of short names many are alike: cv2 is no misspelt csv.
            near = nearest(missing, {n for n in known if "." not in n}, 0.75)
            is_declared = self.package.find_line("package.xml", f"depend>{missing}<")
            is_package = is_declared or uses.is_called_so(self.package, missing)
            if not near or is_package or uses.is_of_debian(missing):
                self.source.absent[missing] = uses.absent(missing, "python")
                return
        else:
            near = nearest(missing.rsplit(".", 1)[-1], {"msg", "srv", "exceptions"})
        yield self.finding(
            "python-names",
            f"There's no Python module {missing}: Python raises a ModuleNotFoundError."
            + perhaps(near),
            node,
            expected="a module that is installed",
            fix=f"Write {near}." if near else "Correct the name of the module.",
        )

    def _imported(self, node: ast.ImportFrom, origin: str) -> Iterator[Finding]:
        if origin == f"{self.package.name}.msg":
            names = self.message_names
        elif self.is_own(origin) or not is_ros(origin):
            return
        else:
            module = load(origin)
            if module is None:
                return
            names = set(dir(module))
        for alias in node.names:
            if alias.name == "*" or alias.name in names:
                continue
            if is_module(f"{origin}.{alias.name}"):
                continue
            self.not_imported.append(alias.name)
            near = nearest(alias.name, {n for n in names if not n.startswith("_")})
            hint = perhaps(near)
            messages_ = load(f"{origin}.msg") if is_module(f"{origin}.msg") else None
            if hasattr(messages_, alias.name):
                hint = f" It's in {origin}.msg."
            yield self.finding(
                "python-names",
                f"{origin} has no {alias.name}: Python raises an ImportError.{hint}",
                node,
                expected=f"a name that {origin} has",
                fix=f"Write {near} for {alias.name}." if near else "Correct the name.",
                why="cannot-import-name",
            )

    def undefined_names(self) -> Iterator[Finding]:
        try:
            found = checker.Checker(self.source.tree, self.file).messages
        except RecursionError:
            return
        reported, name_of = set(), self.package.name
        if {*self.source.stars} - {f"{name_of}.msg", f"{name_of}.srv"}:
            return  # it may have any name
        kinds = messages.UndefinedName, messages.UndefinedLocal, messages.ImportStarUsage
        made = uses.made(self.package) if self.source.stars else ()
        known = {*self.source.imports, *made}
        for message in sorted(found, key=lambda message: message.lineno):
            if not isinstance(message, kinds):
                continue
            name = message.message_args[0]
            if name in reported or isinstance(message, messages.ImportStarUsage) and name in known:
                continue
            if name not in _PYTHON2:
                reported.add(name)
                finding = self._undefined(name, message)
                if type(message) is messages.UndefinedName and self._is_used(name, message.lineno):
                    finding.certainty = CERTAIN
                # What was to be imported under its right name is not there under it, either.
                if nearest(name, self.not_imported):
                    finding.consequence_of = "python-names"
                yield finding
            elif not self._is_asked_for(name, message.lineno):
                reported.add(name)
                yield self._of_python2(name, message.lineno)

    def _is_used(self, name: str, line: int) -> bool:
        """Return whether Python looks for a name where it is not, as far as the source says it.

        https://docs.python.org/3/reference/executionmodel.html#resolution-of-names"""
        source = self.source
        if _HIDES & {*source.imports, *(node.id for node in source.nodes(ast.Name))}:
            return False
        found: list[Definition] = [*source.nodes(ast.FunctionDef), *source.nodes(ast.ClassDef)]
        around = [node for node in found if node.lineno <= line <= last_line(node)]
        if any(is_unused(source, definition) for definition in around):
            return False
        return not self._is_asked_for(name, line)

    def _is_asked_for(self, name: str, line: int) -> bool:
        """Return whether old code asks, before it uses a name, whether Python has it."""
        used = [n for n in self.source.nodes(ast.Name) if (n.id, n.lineno) == (name, line)]
        for node in used:
            if self.source.is_guarded(node, "NameError"):
                return True
            for parent in self.source.above(node):
                asked = ast.walk(parent.test) if isinstance(parent, (ast.If, ast.IfExp)) else ()
                words = (getattr(part, "attr", getattr(part, "id", "")) for part in asked)
                if any(re.search(r"version|PY_?[23]|python[23]", word) for word in words):
                    return True
        return not used

    def _of_python2(self, name: str, line: int) -> Finding:
        return self.finding(
            "python-names",
            f"Python 3 has no {name}: it raises a NameError when it gets here.",
            line,
            expected=_PYTHON2[name],
            fix=f"Write {_PYTHON2[name]} for {name}.",
            why="name-not-defined",
        )

    def _undefined(self, name: str, message: messages.Message) -> Finding:
        if isinstance(message, messages.UndefinedLocal):
            return self.finding(
                "python-names",
                f"{name} is used here before it has a value: the function assigns to it later, so"
                " Python treats it as a local variable.",
                message.lineno,
                expected=f"self.{name}, or 'global {name}' at the beginning of the function",
                fix=f"Make it a member of the class (self.{name}), or declare it global.",
                why="local-before-assignment",
            )
        members = self._members()
        hint, fix = self._meant(name, members)
        return self.finding(
            "python-names",
            f"Nothing is called {name}: Python raises a NameError when it gets here.{hint}",
            message.lineno,
            expected="a name that exists",
            fix=fix,
            why="name-not-defined",
        )

    def _members(self) -> set[str]:
        """Return the names that stand behind self, and those of methods."""
        source = self.source
        behind = {n.attr for n in source.nodes(ast.Attribute) if _is_self(n.value)}
        return behind | {n.name for n in source.nodes(ast.FunctionDef) if source.class_(n)}

    def _meant(self, name: str, members: Collection[str]) -> tuple[str, str]:
        """Return what may be meant by a name that nothing has, and what to do."""
        if name == "self":
            return " A method's first parameter has to be self.", "Write self as the first one."
        if name in members:
            return f" Did you mean self.{name}?", f"Write self.{name}."
        if uses.is_installed(name) or is_module(name):
            return f" The import of {name} is missing.", f"Add the line: import {name}"
        if re.fullmatch(r"U?Int\d+|Float\d+|String|Bool|Empty|Header|Char|Byte", name):
            line = f"from std_msgs.msg import {name}"
            return f" The import of {name} is missing.", f"Add the line: {line}"
        names = {*self.source.imports, "print", "range", "str", "int", "len", "True", "False"}
        names |= {node.id for node in self.source.nodes(ast.Name)} - {name}
        names |= {node.name for node in self.source.nodes(ast.FunctionDef)}
        names |= {node.name for node in self.source.nodes(ast.ClassDef)}
        return perhaps(nearest(name, names)), "Correct the name, or define it before it is used."

    def attributes(self) -> Iterator[Finding]:
        """Names of modules that do not exist, such as rospy.spln and numpy.int."""
        for node in self.source.nodes(ast.Attribute):
            if isinstance(self.source.parents.get(node), ast.Attribute):
                continue
            name = self.source.dotted(node)
            if not name or not is_known(name) or self.is_own(name):
                continue
            if self.source.is_guarded(node, "AttributeError") or isinstance(node.ctx, ast.Store):
                continue
            owner, missing = resolve(name)
            if missing is None:
                continue
            near = nearest(missing, [n for n in dir(owner) if not n.startswith("_")])
            called = getattr(owner, "__name__", name.rsplit(".", 1)[0])
            near = missing if called == "numpy" and hasattr(builtins, missing) else near
            yield self.finding(
                "python-names",
                f"{called} has no {missing}: Python raises an AttributeError when it comes here."
                + perhaps(near),
                node,
                expected=f"a name that {called} has",
                fix=f"Write {near} for {called}.{missing}." if near else "Correct the name.",
                why="py-spln",
            )


def _is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


def _syntax(case: Case) -> Iterator[Finding]:
    """Yield what Python says where it cannot read a source."""
    of_nodes = {file for files in case.facts.sources.values() for file in files}
    for problem in case.facts.problems:
        problem.certainty = problem.certainty or CERTAIN
        if problem.file not in case.facts.relevant:
            problem.certainty = HABIT
            problem.message += " Nothing uses the file."
        elif problem.file not in of_nodes:
            problem.certainty = READ
        yield problem


def _findings(case: Case) -> Iterator[Finding]:
    yield from _syntax(case)
    yield from of_sources(Names)(case)


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=_findings,
    requirements={
        "python-syntax": Requirement("Python can read each script", "wrong", evidence.python),
        "python-names": Requirement(
            "Each name in Python code exists", "wrong", evidence.python_read
        ),
    },
)
