# SPDX-License-Identifier: BSD-3-Clause
"""The test cases that a ledger may name, and how they ended in the last run.

    PACKAGE/NAME/CASE     a test case of PACKAGE's test_NAME.py or .cpp, which rostest runs
    workspace/FILE/CASE   a test case of FILE.py, which pytest runs: in catkin_ws/tests, or in the
                          folder test of a package
    docker/FILE/CASE      a test case of docker/test/FILE.py
    broken/NAME           a defect of mrp_check/defects/ that a rostest of the tutorial must find

A test case names its language, as in test_publisher_py and publisherCpp. If it names none, a test
in C++ is of C++, a defect is of the language that it breaks, and any other test is of both.
"""

import ast
import functools
import itertools
import os
import pathlib
import re
import sys
import textwrap
import xml.etree.ElementTree as ElementTree
from typing import NamedTuple

from sentences import plain

WORKSPACE = pathlib.Path(__file__).resolve().parents[4]
ROOT = WORKSPACE.parent
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402

RESULTS = WORKSPACE / "build" / "test_results"
PACKAGES = ("mrp", "mrp_labs", "mrp_view")
BROKEN = "workspace/test_broken/test_broken_variant_fails"  # its parameters are the defects
CPP_CASE = re.compile(r"((?:^//.*\n)*)(^TEST(?:_F)?\(\w+, (\w+)\)\n(?:.*\n)*?^}\n)", re.MULTILINE)
_LANGUAGE_IN_NAME = re.compile(r"(?:_(cpp|py)|(?<=[a-z])(Cpp|Py))(?=_|[A-Z]|$)")
_LANGUAGES = {"cpp": "C++", "h": "C++", "py": "Python"}


class Case(NamedTuple):
    """A test case.

    line: where it begins in its file
    language: "C++", "Python", or "" for both
    says: its docstring, the comment above it, or what the defect breaks; or ""
    source: its code
    """

    path: pathlib.Path
    line: int
    language: str
    says: str
    source: str

    @property
    def file(self):
        """The path below the repository's folder, as a text."""
        return os.path.relpath(self.path, ROOT)


@functools.lru_cache
def all_tests():
    """Return name -> Case, of all that a ledger may name."""
    tests = {}
    for path, prefix in sorted(_files().items()):
        cases = cpp_cases(path) if path.suffix == ".cpp" else python_cases(path)
        tests.update({f"{prefix}/{name}": case for name, case in cases})
    tests.update({f"broken/{one.name}": _of_defect(one) for one in defects.read_all() if one.fails})
    return tests


def _files():
    """Return path -> the first two parts of its cases' names, of all files with tests."""
    files = {}
    for package in PACKAGES:
        for path in (WORKSPACE / "src" / package / "test").glob("test_*.*"):
            # What rostest runs is a program; pytest's files are not.
            if path.suffix == ".cpp" or os.access(path, os.X_OK):
                files[path] = f"{package}/{path.stem[len('test_') :]}"
    folders = [WORKSPACE / "tests", *WORKSPACE.glob("src/*/test")]
    kinds = {**dict.fromkeys(folders, "workspace"), ROOT / "docker" / "test": "docker"}
    for folder, kind in kinds.items():
        for path in folder.glob("test_*.py"):
            files.setdefault(path, f"{kind}/{path.stem}")
    return files


def python_cases(path):
    """Yield (name, Case) of the test cases of a file in Python."""
    text = path.read_text()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test"):
            first = min([node.lineno, *(one.lineno for one in node.decorator_list)])
            source = textwrap.dedent("\n".join(text.splitlines()[first - 1 : node.end_lineno]))
            says = plain(ast.get_docstring(node) or "")
            yield node.name, Case(path, node.lineno, _language_in(node.name), says, source)


def cpp_cases(path):
    """Yield (name, Case) of the test cases of a file in C++."""
    text = path.read_text()
    for match in CPP_CASE.finditer(text):
        comment, source, name = match.groups()
        line = text.count("\n", 0, match.start(2)) + 1
        says = plain(comment.replace("//", ""))
        yield name, Case(path, line, _language_in(name) or "C++", says, source.rstrip())


def _of_defect(defect):
    text = defect.path.read_text()
    endings = re.findall(r"^\+\+\+ b/\S+\.(\w+)$", text, re.MULTILINE)
    languages = {_LANGUAGES.get(ending, "") for ending in endings}
    language = languages.pop() if len(languages) == 1 else ""
    says = f"{defect.breaks}: the test {defect.fails[1]} finds it."
    return Case(defect.path, 1, language, says, text.rstrip())


def _language_in(name):
    match = _LANGUAGE_IN_NAME.search(name)
    return _LANGUAGES[match.group().strip("_").lower()] if match else ""


def command_of(proof, test):
    """Return the command that runs a proof, in the folder of the repository."""
    kind, name = proof.split("/")[:2]
    if kind == "broken":
        return f"python3 -m pytest catkin_ws/tests/test_broken.py -k {name}"
    if kind in ("workspace", "docker"):
        return f"python3 -m pytest {test.file}"
    if test.path.with_name(f"{name}.test").exists():
        return f"rostest {kind} {name}.test"
    return f"rostest {kind} python.test name:={name}"


def last_results(folder=RESULTS):
    """Return name -> "passed", "failed" or "skipped", from the files of results in a folder."""
    worst = {}
    for name, result in itertools.chain(_of_rostests(folder), _of_pytest(folder)):
        if name.startswith(BROKEN + "["):
            name = "broken/" + name[len(BROKEN) + 1 : -1]
        # A test with parameters has passed if it has with all of them.
        name = name.split("[")[0]
        worst[name] = max(worst.get(name, 0), result)
    return {name: ("passed", "skipped", "failed")[result] for name, result in worst.items()}


def _of_rostests(folder):
    for test in (WORKSPACE / "src").glob("*/test/test_*.*"):
        package, name = test.parts[-3], test.stem[len("test_") :]
        for path in folder.glob(f"{package}/rosunit-{name}*.xml"):
            for case in _cases(path):
                yield f"{package}/{name}/{case.get('name')}", _result(case)


def _of_pytest(folder):
    for path in folder.rglob("*.xml"):
        if path.name.startswith(("pytest_", "sets", "containers")):
            kind = "docker" if path.name == "containers.xml" else "workspace"
            for case in _cases(path):
                file = re.search(r"\btest_\w+", case.get("classname", ""))
                if file:
                    # Behind the name, xdist writes the group of those that one worker runs.
                    name = re.sub(r"@\w+$", "", case.get("name"))
                    yield f"{kind}/{file.group()}/{name}", _result(case)


def _cases(path):
    """Return the test cases of a file of results; none while a test is still writing it."""
    try:
        return list(ElementTree.parse(path).iter("testcase"))
    except ElementTree.ParseError:
        return []


def _result(case):
    """Return 0 if a test case has passed, 1 if it was skipped, 2 if it failed."""
    failed = any(case.find(fault) is not None for fault in ("failure", "error"))
    return 2 if failed else int(case.find("skipped") is not None)
