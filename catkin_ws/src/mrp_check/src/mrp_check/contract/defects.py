# SPDX-License-Identifier: BSD-3-Clause
"""The defects: each is a patch in the package's folder defects/, which breaks a correct package.

The head of a patch says what it breaks, and who must find that:

    Base: format1               the correct package; without this line it is mrp, the tutorial's
    Breaks: a missing colon     what is wrong then
    Erratum: E5                 the same mistake of the original page
    Fails: stop.test test_end   the rostest and its test case that fail,
    Says: != 0                  and what the test case says (a regular expression)
    Finds: python-syntax|exit   the checker's requirements that are not met (a regular expression),
    In: src/a.py: def .*        the file and its line of the finding (a regular expression),
    Tells: colon                and what the finding says (a regular expression)
    Severity: warning           of the finding, if it is only a warning
    Order: 7                    its number, if it is an exercise,
    Kind: fix                   what the student does: see KINDS,
    Task: # A title             what the student reads first,
    Hint: Look at the end.      what the student may ask for,
    Learned: A sentence.        and what they know when they have passed it
    Shows: error: ...           a text that it makes a tool print, and more: see why_entries.py

The value of a field goes on in the lines below it that are indented. There may be several lines In:
each names a place that is right. The head ends where the diff begins.

An exercise is the broken package. Its solution is the patch reversed.
"""

from __future__ import annotations

import dataclasses
import pathlib
import re
import textwrap
from typing import Mapping, Sequence

from mrp_check.contract import resources

# Read what a tool prints, and go where it points; find the cause of what goes wrong; fill a gap
# that a comment marks; write a file from a sentence.
KINDS = ("read", "fix", "complete", "write")

_FIELD = re.compile(r"([A-Z][\w-]*):(?: (.*))?")
_WHY = ("Shows", "Also", "Why", "Fix", "Page", "General", "Try", "Needs")


class DefectError(Exception):
    """A patch's head is not as it must be; the text is one sentence."""


@dataclasses.dataclass(frozen=True)
class Defect:
    """A patch, and what its head says. What it does not say is empty."""

    path: pathlib.Path
    breaks: str
    base: str = "mrp"
    erratum: str = ""
    fails: tuple[str, ...] = ()  # the rostest, the test case
    says: str = ""
    finds: str = ""
    places: tuple[tuple[str, str], ...] = ()  # each a file, and a pattern of a line in it
    tells: str = ""
    severity: str = "error"
    order: int = 0
    kind: str = ""
    task: str = ""
    hint: str = ""
    learned: str = ""
    why: Mapping[str, Sequence[str]] = dataclasses.field(default_factory=dict)  # of why_entries.py

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def title(self) -> str:
        """Of an exercise."""
        return self.task.splitlines()[0].lstrip("# ")

    @property
    def page(self) -> str:
        """The page that explains what the exercise needs: its task names it."""
        match = re.search(r"Read more: `(\w+)`", self.task)
        return match.group(1) if match else ""


def fields(path: pathlib.Path) -> dict[str, list[str]]:
    """Return field -> its values, of the head of a patch. Raises DefectError as fields_of."""
    head = re.split(rb"^(?:--- |diff )", path.read_bytes(), maxsplit=1, flags=re.MULTILINE)[0]
    return fields_of(head.decode(), path.name)


def fields_of(text: str, name: str) -> dict[str, list[str]]:
    """Return field -> its values, of the lines "Field: value" in a text.

    Raises DefectError, with the text's name, if a line is something else.
    """
    found: dict[str, list[list[str]]] = {}
    values: list[list[str]] | None = None
    for line in text.splitlines():
        match = _FIELD.fullmatch(line)
        if match:
            values = found.setdefault(match.group(1), [])
            values.append([match.group(2) or ""])
        elif values is not None and (not line or line[0] == " "):
            values[-1].append(line)
        else:
            raise DefectError(
                f"{name}: expected 'Field: value' or an indented line; found {line!r}."
            )
    return {field: [_text(*lines) for lines in values] for field, values in found.items()}


def _text(first: str, *others: str) -> str:
    """Return a value: what stands beside the field, and the lines below without indentation."""
    below = textwrap.dedent("\n".join(others)).strip()
    return "\n".join(filter(None, (first, below)))


def read(path: pathlib.Path) -> Defect:
    """Return the Defect of a patch. Raises DefectError if its head is not as it must be."""
    found = fields(path)
    pairs = (value.partition(": ") for value in found.pop("In", ()))
    why = {field: found.pop(field) for field in _WHY if field in found}
    try:
        values = {field.lower(): value for field, (value,) in found.items()}
        return Defect(
            path=path,
            places=tuple((file, pattern) for file, _, pattern in pairs),
            why=why,
            fails=tuple(values.pop("fails", "").split()),
            order=int(values.pop("order", 0)),
            **values,
        )
    except (TypeError, ValueError) as error:
        raise DefectError(
            f"{path.name}: expected the fields that defects.py explains, each once; found: {error}."
        ) from None


def read_all(folder: pathlib.Path | None = None) -> list[Defect]:
    """Return all defects, by name. Raises DefectError if one is not as it must be.

    folder: of the patches; without it, that of this package, or where it is installed
    """
    folder = folder or resources.folder("defects")
    found = [read(path) for path in sorted(folder.glob("*.patch"))]
    if not found:
        raise DefectError(f"Expected patches in {folder}; there's none.")
    return found


def exercises(folder: pathlib.Path | None = None) -> list[Defect]:
    """Return the defects that are exercises, in their order. Raises DefectError as read_all."""
    return sorted(
        (defect for defect in read_all(folder) if defect.order), key=lambda defect: defect.order
    )
