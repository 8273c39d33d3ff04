# SPDX-License-Identifier: BSD-3-Clause
"""What is left of a package's code without its names, texts, numbers, comments and layout.

A fingerprint is a run of words of the code. Who renames, moves functions, and lays out anew keeps
most of them.
"""

from __future__ import annotations

import bisect
import dataclasses
import keyword
import re
from typing import Iterator

from mrp_check.package.package import Package

_RUN = 12  # words in a fingerprint
_MOST_TEXT = 200_000  # characters of one package that are looked at

_REST = r"""
    |(?P<text>(?:\b(?:[rbfuRBFU]{1,2}|u8|L))?(?:"(?:\\.|[^"\\\n])*"?|'(?:\\.|[^'\\\n])*'?))
    |(?P<number>\d[\w.']*) | (?P<name>[^\W\d]\w*) | (?P<sign>[^\s;{}])"""
# What begins with no name is no word: comments, Python's long texts, and what is imported.
_PYTHON = r"""\#[^\n]* | ^[ \t]*(?:import|from)\b[^\n]*
    |(?s:\b[rbfuRBFU]{0,2}(?P<quotes>\"{3}|'{3}).*?(?:(?P=quotes)|\Z))"""
_CPP = r"//[^\n]* | (?s:/\*.*?(?:\*/|\Z)) | ^[ \t]*(?:\#|using\b)[^\n]*"
_WORDS = {
    "python": re.compile(_PYTHON + _REST, re.MULTILINE | re.VERBOSE),
    "cpp": re.compile(_CPP + _REST, re.MULTILINE | re.VERBOSE),
}
_WORDS["header"] = _WORDS["cpp"]

# The words that nobody can rename, of both languages and of ROS. Each other name is like any other.
_KEPT = {
    *keyword.kwlist,
    *"auto bool break case catch class const continue default delete do double else enum".split(),
    *"float for if int namespace new nullptr operator override private protected public".split(),
    *"return static struct switch template this throw try typename unsigned virtual void".split(),
    *"while std bind thread mutex range len print ros rospy NodeHandle Publisher".split(),
    *"Subscriber Timer TimerEvent Rate Duration Time advertise subscribe publish".split(),
    *"createTimer createWallTimer init init_node ok spin spinOnce is_shutdown".split(),
    *"on_shutdown sleep get_namespace getNamespace get_name loginfo logwarn".split(),
    *"ROS_INFO ROS_INFO_STREAM ROS_WARN param get_param".split(),
}

Place = tuple[str, int, int]  # a file, its first and its last line


@dataclasses.dataclass
class Code:
    """The code of a package.

    name: of its submission
    lines: file -> its lines
    places: fingerprint -> where it is first
    """

    name: str
    lines: dict[str, list[str]]
    places: dict[int, Place]


def of_package(package: Package, name: str = "") -> Code:
    """Return the code of a package: that of its C++ and Python files."""
    code = Code(name, {}, {})
    left = _MOST_TEXT
    for file in package.of_kind(*_WORDS):
        text = package.text(file)[:left]
        left -= len(text)
        code.lines[file] = text.split("\n")
        words = [*_words(text, package.kind(file))]
        for run in zip(*(words[start:] for start in range(_RUN))):
            place = (file, run[0][1], run[-1][1])
            code.places.setdefault(hash(tuple(word for word, _ in run)), place)
    return code


def _words(text: str, kind: str) -> Iterator[tuple[str, int]]:
    """Yield each word with its line."""
    ends = [match.start() for match in re.finditer("\n", text)]
    for match in _WORDS[kind].finditer(text):
        what = match.lastgroup or "quotes"
        if what != "quotes":
            is_kept = what == "sign" or match[what] in _KEPT
            yield match[what] if is_kept else what, bisect.bisect_left(ends, match.start()) + 1
