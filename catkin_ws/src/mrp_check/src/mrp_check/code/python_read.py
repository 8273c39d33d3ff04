# SPDX-License-Identifier: BSD-3-Clause
"""Reads a Python source; or says why Python cannot read it."""

from __future__ import annotations

import ast
import re
from typing import Sequence

from mrp_check.code.python_source import Source
from mrp_check.contract.finding import Finding
from mrp_check.package.package import Package

# What Python says -> what it means, where Python itself doesn't say that.
_SYNTAX = (
    (r"unindent does not match|unexpected indent", "The line isn't indented like those around it."),
    (r"multiple exception types", "In Python 3, write: except NAME as VARIABLE."),
    (
        r"invalid character|invalid non-printable",
        "Perhaps it was copied from a page or a document.",
    ),
)
_SHOWN = 12  # lines that a hint names
# What Python says -> the entry of the page why.
_WHY = (
    (r"indented block|unindent does not|unexpected indent", "python-indent"),
    (r"inconsistent use of tabs", "python-tabs"),
    (r"in call to 'print'", "python2"),
    (r"multiple exception types", "python2"),
    (r"", "python-syntax"),
)
_EXCEPT = re.compile(r"^([ \t]*except[ \t]+(?:[\w.]+|\([^()]*\)))[ \t]*,[ \t]*(\w+)[ \t]*:")


def _tabs(lines: Sequence[str]) -> str:
    """Return a hint if some lines are indented with tabs and others with spaces, or nothing."""
    by = {
        kind: [str(number) for number, text in enumerate(lines, 1) if re.match(shape, text)]
        for kind, shape in (("tabs", r"\t+\S"), ("spaces", r" +\S"))
    }
    kind, fewer = min(by.items(), key=lambda item: len(item[1]))
    if not fewer:
        return ""
    more = ", ..." if len(fewer) > _SHOWN else ""
    shown = ", ".join(fewer[:_SHOWN]) + more
    return f"Tabs and spaces are mixed: use four spaces for each level. Lines with {kind}: {shown}."


def _source(file: str, text: str) -> Source:
    """Return the Source of a text. Raises SyntaxError where Python 2 is written.

    From Python 3.14 on, `except OSError, e:` means two classes: a small letter means a variable.
    """
    source = Source(file, text)
    for handler in source.nodes(ast.ExceptHandler):
        last = handler.type.elts[-1] if isinstance(handler.type, ast.Tuple) else None
        line = text.splitlines()[handler.lineno - 1]
        if isinstance(last, ast.Name) and last.id[0].islower() and _EXCEPT.match(line):
            place = (file, handler.lineno, handler.col_offset + 1, line)
            raise SyntaxError("multiple exception types must be parenthesized", place)
    return source


def read(package: Package, file: str) -> tuple[Source | None, Finding | None]:
    """Return (the Source or None, the Finding that says why there is none, or None)."""
    data = package.bytes(file)
    try:
        if b"\0" not in data:
            data.decode("utf-8")
        return _source(file, package.text(file)), None
    except UnicodeDecodeError:
        try:
            return Source(file, data), None  # Python itself reads the coding line
        except (SyntaxError, ValueError, UnicodeDecodeError):
            return None, None  # the stage files has said it
    except SyntaxError as error:
        return None, _syntax(package, file, error)
    except (ValueError, RecursionError, MemoryError) as error:
        return None, Finding(
            "python-syntax",
            f"Python can't read {file}: {error}.",
            file,
            1,
            expected="Python",
            seen=str(error),
        )


def _syntax(package: Package, file: str, error: SyntaxError) -> Finding:
    text, line = error.msg or "invalid syntax", error.lineno or 1
    lines = package.lines(file)
    line = min(line, len(lines))
    shown = lines[line - 1].strip()
    hint = next((sentence for shape, sentence in _SYNTAX if re.search(shape, text)), "")
    if re.search(r"inconsistent use|unindent|unexpected indent", text):
        hint = _tabs(lines) or hint
    if text == "invalid syntax":
        if shown.startswith("//"):
            hint = "A comment begins with # in Python, not with //."
        elif re.match(r"global\s+\w+\s*=", shown):
            hint = "'global NAME' and 'NAME = ...' are two statements, on two lines."
    return Finding(
        "python-syntax",
        f"Python can't read {file}: {text}, on line {line}. {hint}".strip(),
        file,
        line,
        expected="valid Python 3",
        seen=lines[line - 1].strip(),
        fix=f"Correct the line; `python3 -m py_compile {file}` says whether Python can read it.",
        why=next(why for shape, why in _WHY if re.search(shape, text)),
    )
