# SPDX-License-Identifier: BSD-3-Clause
"""XML with its lines: the elements of a file, or why it is no XML."""

from __future__ import annotations

import dataclasses
import re
import xml.parsers.expat

from mrp_check.contract.finding import Finding
from mrp_check.package.package import Package, declared_entity


@dataclasses.dataclass
class Element:
    """One XML element; line: where it begins."""

    tag: str
    attributes: dict
    line: int
    parents: list


class UnclosedError(xml.parsers.expat.ExpatError):
    """opened: the element that is open where the parser stops"""

    def __init__(self, error: xml.parsers.expat.ExpatError, opened: Element) -> None:
        super().__init__(str(error))
        self.code, self.lineno, self.opened = error.code, error.lineno, opened


class EntityError(xml.parsers.expat.ExpatError):
    """The file declares an entity: it is not read at all."""

    def __init__(self, line: int) -> None:
        super().__init__("an entity is declared")
        self.code, self.lineno = 0, line


def elements(data: bytes) -> list[Element]:
    """Return the Elements of an XML file's bytes. Raises xml.parsers.expat.ExpatError."""
    line = declared_entity(data)
    if line:
        raise EntityError(line)
    found: list[Element] = []
    stack: list[Element] = []
    parser = xml.parsers.expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, parser.CurrentLineNumber, list(stack))
        found.append(element)
        stack.append(element)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: stack.pop()
    try:
        parser.Parse(data, True)
    except xml.parsers.expat.ExpatError as error:
        raise UnclosedError(error, stack[-1]) if stack else error from None
    return found


def xml_finding(
    id_: str, package: Package, path: str, error: xml.parsers.expat.ExpatError, why: str
) -> Finding:
    """Return the Finding about a file that is no XML."""
    what = xml.parsers.expat.ErrorString(error.code) or str(error)
    line = error.lineno
    hint, cause = "", line
    unclosed = what in ("mismatched tag", "no element found")
    if unclosed and isinstance(error, UnclosedError):
        cause = error.opened.line
        hint = f"<{error.opened.tag}> is opened there and not closed."
    elif what == "not well-formed (invalid token)":
        cause, hint = _bad_token(package, path, line)
    return Finding(
        id_,
        f"{path} isn't valid XML: {what}, noticed on line {line}. {hint}".strip(),
        path,
        cause,
        expected="XML in which each tag that is opened is closed, and each value is in quotes",
        seen=package.line(path, min(cause, len(package.lines(path)))),
        fix="Correct this line; `xmllint --noout` says whether the file is well-formed.",
        why=why,
    )


def _bad_token(package: Package, path: str, line: int) -> tuple[int, str]:
    """Return the line that is to blame for a character that cannot stand where it does."""
    lines = package.lines(path)
    for number in range(line, 0, -1):
        text = lines[number - 1] if number <= len(lines) else ""
        if number == line and re.search(r"<!--(?:(?!-->).)*--(?!>)", text):
            return line, "A comment can't contain two hyphens (--)."
        # A tag that never ends swallows the lines below it.
        if number < line and text.count("<") > text.count(">"):
            return number, "The tag that begins there has no end."
        if text.count('"') % 2:
            return number, "A quotation mark is missing there."
        if number < line and ">" in text:
            break
    return line, "Perhaps a quotation mark, a > or an = is missing, or & should be &amp;."
