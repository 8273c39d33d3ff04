#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Say what an error text means, why it is printed, and how to fix it.

Usage: why.py [TEXT]; without a text it reads what is pasted or piped into it, such as a whole log.
why_entries.py says what an entry looks like, and why_search.py finds the nearest ones.
"""

import codecs
import os
import re
import sys

from why_entries import entries, shown_on  # finds the checker
from why_search import Index

from mrp_check.contract import resources  # isort:skip

_TRACEBACK = 5000  # characters above an exception
_WIDE = 300  # characters of a line that is quoted
_OF_PYTHON = re.compile(r"\b(?:Index|Key|Type|Value|Attribute)Error\b")
# The last place of a traceback is in a file of ROS: what was given to it is wrong, not its code.
_PLACE = re.compile(r'^[ \t]*File "([^"\n]*)", line \d', re.MULTILINE)
_IN_ROS = re.compile(
    r".*/(?:dist|site)-packages/((?:ros\w+|genpy|genmsg|tf2?\w*|actionlib|\w+_msgs)/.*)"
)


def answer(found, text=""):
    """Return what the user reads about the answers to a text."""
    if not found:
        return (
            "I know no message like this one. Look for the first line that says 'error', and "
            "try that line by itself.\nAll the messages I know: " + _link("why")
        )
    parts, before = [], ()
    for number, match in enumerate(found, 1):
        lines = [*match.lines, match.below] if match.below else match.lines
        shown = ["Or, for the same lines:"] if match.lines == before else lines
        parts.append(_one_answer(number, match, shown, text))
        before = match.lines
    return "\n\n".join(parts)


def _one_answer(number, match, shown, text):
    shown = [line if len(line) <= _WIDE else line[:_WIDE] + " ..." for line in shown]
    lines = [f"{number}. {shown[0]}", *("   " + line for line in shown[1:])]
    if match.doubtful:
        lines.append(f"   I'm not sure, but it looks like: {shown_on(match.entry.shows[0])[0]}")
    lines += [f"   why:  {match.entry.why}", f"   fix:  {match.entry.fix}"]
    at = text.find(match.lines[0])
    places = _PLACE.findall(text[max(at - _TRACEBACK, 0) : max(at, 0)])
    inside = _IN_ROS.fullmatch(places[-1]) if places else None
    if inside and _OF_PYTHON.search("\n".join(match.lines)):
        lines.append(f"   note: It happened in ROS's own {inside[1]}: look at what you passed it.")
    return "\n".join([*lines, f"   page: {_link(match.entry.address)}"])


def _link(address):
    page, hash_, anchor = address.partition("#")
    return resources.link_to(f"pages/{page}.html{hash_}{anchor}")


def decoded(data):
    """Return the text of what was piped in. PowerShell's `>` writes UTF-16."""
    utf16 = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    return data.decode("utf-16" if utf16 else "utf-8-sig", errors="replace")


def main(arguments):
    text = " ".join(arguments).strip()
    if not text:
        if sys.stdin.isatty():
            print("Paste the error text, then press Enter and Ctrl-D:", file=sys.stderr)
        text = decoded(sys.stdin.buffer.read())
    is_binary = text.count("\N{REPLACEMENT CHARACTER}") > len(text) / 4
    if is_binary or not text.strip():
        what = "a binary file" if is_binary else "nothing"
        print(f"error: expected an error text, found {what}", file=sys.stderr)
        return 2
    found = Index(entries()).nearest(text)
    print(answer(found, text), flush=True)
    return 0 if found else 1


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:  # such as: make why | head -3
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
