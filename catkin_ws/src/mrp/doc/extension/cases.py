# SPDX-License-Identifier: BSD-3-Clause
"""The tests that a ledger may name, and how they ended.

    PACKAGE/NAME/CASE     a test case of PACKAGE's test_NAME.py or .cpp, which rostest runs
    workspace/FILE/CASE   a test case of FILE.py, which pytest runs: in catkin_ws/tests, or in the
                          folder test of a package
    docker/FILE/CASE      a test case of docker/test/FILE.py
    broken/NAME           the defect NAME.patch, which a rostest of the tutorial must find
    lab/NAME              the lab NAME.launch, which must show what labs.yaml says

A test in C++ proves nothing about Python. Nor does one in Python with _cpp in its name, such as
test_publisher_cpp, or a defect of a C++ file. The same holds the other way round.
"""

import ast
import datetime
import functools
import pathlib
import re
import textwrap
import xml.etree.ElementTree as ElementTree
from typing import NamedTuple

WORKSPACE = pathlib.Path(__file__).resolve().parents[4]
ROOT = WORKSPACE.parent
RESULTS = WORKSPACE / "build" / "test_results"
_FILES = {
    "broken": ["catkin_ws/src/mrp_check/defects/{}.patch"],
    "docker": ["docker/test/{}.py"],
    "lab": ["catkin_ws/src/mrp_labs/launch/{}.launch"],
    "workspace": ["catkin_ws/tests/{}.py", "catkin_ws/src/*/test/{}.py"],
}
_CPP_CASE = re.compile(r"((?:^//.*\n)*)(^TEST(?:_F)?\(\w+, (\w+)\)\n(?:.*\n)*?^}\n)", re.MULTILINE)
_LANGUAGES = {"cpp": "C++", "py": "Python"}


class Case(NamedTuple):
    """A test case.

    language: "C++", "Python", or "" for both
    says: its docstring or comment, or that of its file; what a defect breaks, or a lab claims
    source: its code
    """

    path: pathlib.Path
    line: int
    language: str
    says: str
    source: str


def find(name):
    """Return the Case of a name, or None."""
    found = (in_file(path).get(name.split("/")[-1]) for path in files(name))
    return next(filter(None, found), None)


def files(name):
    """Return the files in which a test may be, by the first two parts of its name."""
    kind, stem = [*name.split("/"), ""][:2]
    patterns = _FILES.get(kind, [f"catkin_ws/src/{kind}/test/test_{{}}.*"])
    return [path for pattern in patterns for path in sorted(ROOT.glob(pattern.format(stem)))]


@functools.lru_cache
def in_file(path):
    """Return the Cases of a file, by the last part of their names."""
    text = path.read_text()
    if path.suffix == ".patch":
        languages = set(re.findall(r"^\+\+\+ b/\S+\.(cpp|py)$", text, re.MULTILINE))
        language = _LANGUAGES[languages.pop()] if len(languages) == 1 else ""
        return {path.stem: Case(path, 1, language, re.match("Breaks: (.*)", text)[1], text)}
    if path.suffix == ".launch":
        return {path.stem: Case(path, 1, "", re.match("<!-- (.*) -->", text)[1], text)}
    return dict((_cpp_cases if path.suffix == ".cpp" else _python_cases)(path, text))


def _python_cases(path, text):
    file = ast.parse(text)
    for node in ast.walk(file):
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test"):
            first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
            source = textwrap.dedent("\n".join(text.splitlines()[first - 1 : node.end_lineno]))
            language = re.search("_(cpp|py)(?=_|$)", node.name)
            language = _LANGUAGES[language[1]] if language else ""
            says = ast.get_docstring(node) or ast.get_docstring(file) or ""
            yield node.name, Case(path, node.lineno, language, says, source)


def _cpp_cases(path, text):
    head = re.match(r"(?:// SPDX.*\n)?((?:// .*\n)*)", text)[1]
    for match in _CPP_CASE.finditer(text):
        says = (match[1] or head).replace("// ", "")
        line = text.count("\n", 0, match.start(2)) + 1
        yield match[3], Case(path, line, "C++", says, match[2])


def result(name):
    """Return how a test ended when it last ran here, and on which day; None if it didn't run.

    A test with parameters has passed if it has with all of them.
    """
    kind, file, case = [*name.split("/"), ""][:3]
    pattern, of_file = f"{kind}/rosunit-{file}*.xml", None
    if kind in _FILES:
        pattern, of_file = ("**/containers.xml" if kind == "docker" else "*.xml"), file
    if kind == "broken":
        of_file, case = "test_broken", f"test_broken_variant_fails[{file}]"
    if kind == "lab":
        of_file, case = "test_lab", f"test_lab_shows_its_claim[{file}]"
    ends = [
        (end, day)
        for place, case_name, end, day in ended(pattern)
        # Behind a test's name come its parameters, and xdist's group.
        if (of_file is None or of_file in place)
        and re.match(rf"{re.escape(case)}([\[@]|$)", case_name)
    ]
    worst = ("failed", "skipped", "passed")
    return min(ends, key=lambda pair: worst.index(pair[0]), default=None)


def is_of_test_all(name):
    """Say whether `make test-all` runs a test: by its mark, or by that of its file."""
    case = find(name)
    if case is None or name.startswith("docker/"):
        return False
    marks = re.findall(r"\bmark\.(quick|slow|sets)\b", case.source)
    of_file = re.findall(r"^pytestmark = .*\bmark\.(\w+)", case.path.read_text(), re.MULTILINE)
    return "sets" not in (marks or of_file)


@functools.lru_cache
def ended(pattern):
    """Return of each case in files of results: its class, its name, how it ended, and the day."""
    found = []
    for path in RESULTS.glob(pattern):
        day = str(datetime.date.fromtimestamp(path.stat().st_mtime))
        try:
            cases = ElementTree.parse(path).iter("testcase")
        except ElementTree.ParseError:  # a test is still writing it
            continue
        for case in cases:
            tags = {child.tag for child in case}
            end = "skipped" if "skipped" in tags else "passed"
            end = "failed" if tags & {"failure", "error"} else end
            found.append((case.get("classname", "").split("."), case.get("name"), end, day))
    return found
