# SPDX-License-Identifier: BSD-3-Clause
"""The tests that may be proofs: what each quotes, and how its last run ended.

A proof is named

    PACKAGE/NAME/CASE     a test case of PACKAGE's test_NAME.py or .cpp, which rostest runs
    workspace/FILE/CASE   a test case of FILE.py, which pytest runs: in catkin_ws/tests, or in the
                          folder test of a package
    docker/FILE/CASE      a test case of docker/test/FILE.py
    broken/NAME           a defect of catkin_ws/defects/ that a rostest of the tutorial must find

and quotes the sentences that it proves:

    @proves("A sentence.", "Another one.")    above a test case in Python: mrp_testing.proves
    // Proves: A sentence, which goes on      above a test case in C++
    //   in the lines below it.
    Proves: A sentence.                       in the head of a defect

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


class EvidenceError(Exception):
    """A test's quotes cannot be read; the text says which and why."""


class Test(NamedTuple):
    """A test that may be a proof.

    line: where it begins in its file
    quotes: the sentences that it proves
    language: "C++", "Python", or "" for both
    source: its code
    """

    path: pathlib.Path
    line: int
    quotes: tuple
    language: str
    source: str

    @property
    def file(self):
        """The path below the repository's folder, as a text."""
        return str(self.path.relative_to(ROOT))


@functools.lru_cache
def all_tests():
    """Return proof -> Test, of everything that a proof may be. Raises EvidenceError."""
    tests = {}
    for path, prefix in sorted(_files().items()):
        cases = cpp_cases(path) if path.suffix == ".cpp" else python_cases(path)
        tests.update({f"{prefix}/{name}": test for name, test in cases})
    tests.update({f"broken/{one.name}": _of_defect(one) for one in defects.read_all() if one.fails})
    return tests


def _files():
    """Return path -> the first two parts of its proofs' names, of all files with tests."""
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
    """Yield (name, Test) of the test cases of a file in Python. Raises EvidenceError."""
    text = path.read_text()
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.FunctionDef) or not node.name.startswith("test"):
            continue
        quotes, skip = [], set()
        for decorator in filter(is_proves, node.decorator_list):
            skip |= set(range(decorator.lineno, decorator.end_lineno + 1))
            quotes += [_text_of(one, path) for one in decorator.args]
        first = min([node.lineno, *(one.lineno for one in node.decorator_list)])
        lines = list(enumerate(text.splitlines(), 1))[first - 1 : node.end_lineno]
        source = textwrap.dedent("\n".join(line for number, line in lines if number not in skip))
        language = _language_in(node.name)
        yield node.name, Test(path, node.lineno, tuple(quotes), language, source)


def is_proves(decorator):
    """Say whether a decorator is @proves(...)."""
    return isinstance(decorator, ast.Call) and getattr(decorator.func, "id", "") == "proves"


def _text_of(argument, path):
    if not isinstance(argument, ast.Constant) or not isinstance(argument.value, str):
        raise EvidenceError(
            f"{path.name}, line {argument.lineno}: expected a text in quotes in @proves(...). "
            "Nothing is computed there, because the file is read and not run: write it out."
        )
    return plain(argument.value)


def cpp_cases(path):
    """Yield (name, Test) of the test cases of a file in C++."""
    text = path.read_text()
    for match in CPP_CASE.finditer(text):
        comment, source, name = match.groups()
        _, *quotes = re.split(r"^// Proves:", comment, flags=re.MULTILINE)
        quotes = tuple(plain(re.sub(r"^//", "", quote, flags=re.MULTILINE)) for quote in quotes)
        line = text.count("\n", 0, match.start(2)) + 1
        yield name, Test(path, line, quotes, _language_in(name) or "C++", source.rstrip())


def _of_defect(defect):
    text = defect.path.read_text()
    endings = re.findall(r"^\+\+\+ b/\S+\.(\w+)$", text, re.MULTILINE)
    languages = {_LANGUAGES.get(ending, "") for ending in endings}
    language = languages.pop() if len(languages) == 1 else ""
    quotes = tuple(map(plain, defect.proves))
    return Test(defect.path, 1, quotes, language, text.rstrip())


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
    """Return proof -> whether its last run passed, from the files of results in a folder."""
    passed = {}
    for proof, good in itertools.chain(_of_rostests(folder), _of_pytest(folder)):
        if proof.startswith(BROKEN + "["):
            proof = "broken/" + proof[len(BROKEN) + 1 : -1]
        # A test with parameters has passed if it has with all of them.
        proof = proof.split("[")[0]
        passed[proof] = passed.get(proof, True) and good
    return passed


def _of_rostests(folder):
    for test in (WORKSPACE / "src").glob("*/test/test_*.*"):
        package, name = test.parts[-3], test.stem[len("test_") :]
        for path in folder.glob(f"{package}/rosunit-{name}*.xml"):
            for case in _cases(path):
                yield f"{package}/{name}/{case.get('name')}", _passed(case)


def _of_pytest(folder):
    for path in folder.rglob("*.xml"):
        if path.name.startswith(("pytest_", "sets", "containers")):
            kind = "docker" if path.name == "containers.xml" else "workspace"
            for case in _cases(path):
                file = re.search(r"\btest_\w+", case.get("classname", ""))
                if file:
                    # Behind the name, xdist writes the group of those that one worker runs.
                    name = re.sub(r"@\w+$", "", case.get("name"))
                    yield f"{kind}/{file.group()}/{name}", _passed(case)


def _cases(path):
    """Return the test cases of a file of results; none while a test is still writing it."""
    try:
        return list(ElementTree.parse(path).iter("testcase"))
    except ElementTree.ParseError:
        return []


def _passed(case):
    return not any(case.find(fault) is not None for fault in ("failure", "error", "skipped"))
