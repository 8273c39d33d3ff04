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
    Missed: WHY                 the checker is known not to find it
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
from typing import Iterator, Mapping, Sequence

from mrp_check.contract import resources

# Read what a tool prints, and go where it points; find the cause of what goes wrong; fill a gap
# that a comment marks; write a file from a sentence.
KINDS = ("read", "fix", "complete", "write")

_FIELD = re.compile(r"([A-Z][\w-]*):(?: (.*))?")
# A patch has all fields of a group, or none.
_GROUPS = (
    ("Fails", "Says"),
    ("Finds", "In", "Tells"),
    ("Order", "Kind", "Task", "Hint", "Learned"),
)
_WHY = ("Shows", "Also", "Why", "Fix", "Page", "General", "Try", "Needs")
_FIELDS = (
    *("Base", "Breaks", "Erratum", "Missed", "Severity"),
    *(field for group in _GROUPS for field in group),
    *_WHY,
)
_SEVERAL = ("In", "Shows", "Also")
_FORMS = {
    "Erratum": (r"[EP][1-9]\d*", "the number of an erratum, such as E5"),
    "Fails": (r"\w+\.test \w+", "a rostest and a test case of it"),
    "In": (r"\S+: .+", "a file, a colon, and a regular expression"),
    "Kind": ("|".join(KINDS), f"one of {', '.join(KINDS)}"),
    "Order": (r"[1-9]\d*", "a number from 1 on"),
    "Severity": (r"warning", "warning, or no such line for an error"),
    "Task": (
        r"# .+\n\n(?s:.+)The page: `\w+`(?s:.*)",
        "a title such as '# A title', an empty line, a text, and 'The page: `queues`.'",
    ),
}
_PATTERNS = ("Says", "Finds", "In", "Tells")


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
    missed: str = ""
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
        match = re.search(r"The page: `(\w+)`", self.task)
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
    for fault in _faults(found):
        raise DefectError(f"{path.name}: {fault}.")
    pairs = (value.partition(": ") for value in found.pop("In", ()))
    why = {field: found.pop(field) for field in _WHY if field in found}
    values = {field.lower(): value for field, (value,) in found.items()}
    return Defect(
        path=path,
        places=tuple((file, pattern) for file, _, pattern in pairs),
        why=why,
        fails=tuple(values.pop("fails", "").split()),
        order=int(values.pop("order", 0)),
        **values,
    )


def _faults(found: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Yield what is wrong with a head, each fault as a sentence without its full stop."""
    for field, values in found.items():
        if field not in _FIELDS:
            yield f"there is no field {field}: expected one of {', '.join(_FIELDS)}"
        elif len(values) > 1 and field not in _SEVERAL:
            yield f"expected the field {field} once; found it {len(values)} times"
        for value in values:
            yield from _faults_of_value(field, value)
    if "Breaks" not in found:
        yield "the field Breaks is missing"
    if "Fails" not in found and "Finds" not in found:
        yield "one of the fields Fails and Finds is missing: nobody would find the defect"
    for group in _GROUPS:
        if not set(group) & set(found):
            continue
        # The checker checks an exercise.
        needed = (*group, "Finds") if "Order" in group else group
        for missing in (field for field in needed if field not in found):
            yield f"the field {missing} is missing, as one of {', '.join(group)} is there"
    if found.get("Base", ["mrp"]) != ["mrp"] and "Fails" in found:
        yield "a patch with the field Fails breaks mrp: expected no other Base"


def _faults_of_value(field: str, value: str) -> Iterator[str]:
    form, meaning = _FORMS.get(field, (r"(?s).+", "a value"))
    if not re.fullmatch(form, value):
        yield f"expected {meaning}, in the field {field}; found {value!r}"
    elif field in _PATTERNS:
        try:
            re.compile(value.split(": ", 1)[-1] if field == "In" else value)
        except re.error as error:
            yield f"expected a regular expression in the field {field}; found {value!r}: {error}"


def read_all(folder: pathlib.Path | None = None) -> list[Defect]:
    """Return all defects, by name. Raises DefectError if one is not as it must be.

    folder: of the patches; without it, that of this package, or where it is installed
    """
    folder = folder or resources.folder("defects")
    found = [read(path) for path in sorted(folder.glob("*.patch"))]
    if not found:
        raise DefectError(f"Expected patches in {folder}; there is none.")
    orders: dict[int, Defect] = {}
    for one in found:
        if one.order and orders.setdefault(one.order, one) is not one:
            raise DefectError(
                f"{orders[one.order].path.name} and {one.path.name} are both exercise {one.order}: "
                "expected one exercise for each number."
            )
    return found


def exercises(folder: pathlib.Path | None = None) -> list[Defect]:
    """Return the defects that are exercises, in their order. Raises DefectError as read_all."""
    return sorted((one for one in read_all(folder) if one.order), key=lambda one: one.order)
