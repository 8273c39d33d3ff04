# SPDX-License-Identifier: BSD-3-Clause
"""No file and no function grows longer than somebody can read at one sitting."""

import ast
import subprocess

import pytest
from mrp_testing.workspace import ROOT

pytestmark = pytest.mark.slow

MOST = 400  # lines of a file
MOST_OF_FUNCTION = 40


def texts(*patterns):
    """Return path -> text of the files of the repository with these endings."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *patterns]
    names = subprocess.check_output(command, cwd=ROOT, text=True).splitlines()
    return {name: (ROOT / name).read_text() for name in names if (ROOT / name).is_file()}


def long_functions(text):
    """Return (name, lines) of each Python function that is too long."""
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
    functions = [one for one in ast.walk(ast.parse(text)) if isinstance(one, kinds)]
    lengths = ((one.name, one.end_lineno - one.lineno + 1) for one in functions)
    return [(name, length) for name, length in lengths if length > MOST_OF_FUNCTION]


def test_no_file_is_too_long():
    lengths = {
        name: text.count("\n") for name, text in texts(*"*.py *.js *.cpp *.h *.sh".split()).items()
    }
    assert len(lengths) > 400
    assert {name: length for name, length in lengths.items() if length > MOST} == {}


def test_no_function_is_too_long():
    # The original is quoted as it is printed.
    python = texts("*.py", ":!catkin_ws/tests/errata/original")
    found = {name: long_functions(text) for name, text in python.items()}
    assert {name: functions for name, functions in found.items() if functions} == {}


def test_a_long_function_is_seen():
    line = "    pass\n"
    assert long_functions("def short():\n" + line * (MOST_OF_FUNCTION - 1)) == []
    too_long = "class A:\n  async def long():\n" + line * MOST_OF_FUNCTION
    assert long_functions(too_long) == [("long", MOST_OF_FUNCTION + 1)]
