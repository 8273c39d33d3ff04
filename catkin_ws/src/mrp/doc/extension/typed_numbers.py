# SPDX-License-Identifier: BSD-3-Clause
"""The numbers that somebody has typed into a sentence, in digits or in words.

A page takes its numbers from where they are defined: see value.py. A typed number is a fault
(claims.py), unless a test proves its sentence, or one of EXCEPTIONS or FREE says why it may be.
"""

import re

WORDS = "zero one two three four five six seven eight nine ten eleven twelve".split()
# "one" is also a pronoun. An ordinal says where something stands: it is no number here.
_MORE = "zero twenty thirty forty fifty hundred thousand million half twice dozen".split()
_NUMBER = re.compile(
    rf"(?<![\w./])(?<!\w-)\d(?:[\d.,]*\d)?(?!\w)|\b(?:{'|'.join([*WORDS[2:], *_MORE])})\b",
    re.IGNORECASE,
)

# What a number may be that is typed -> why.
EXCEPTIONS = {
    r"Debian 1[23]( (or|and) 1[23])?|ROS [12]|Python [23](\.\d+)?|CMake 4|WSL 2|4\.0": "the "
    "version of a program or a licence is a part of its name",
    r"RFC \d+(, [\d.]+)?": "a standard is named by its number",
    r"(in|in May|since the beginning of|Beuchat,) (19|20)\d\d": "a year does not change",
    r"terminals? \d( and \d)?": "the terminals of the pages are named by numbers",
    r"takes \d+ minutes|about \d+ hours": "an estimate",
    r"the page \"[^\"]+\"": "a page is named by its title",
    r"(two|both) (publishers|subscribers)|four nodes": "these are the tutorial's nodes, as a "
    "test of the contract sees",
}
_EXCEPTIONS = re.compile("|".join(f"(?:{one})" for one in EXCEPTIONS), re.IGNORECASE)

# The reasons of claims.py for sentences whose numbers are free -> why.
FREE = {
    "definition": "the number belongs to what the word means",
    "entry": "the number is that of the entry's commands",
    "heading": "what stands below it says the number",
    "instruction": "the number is the task's own",
    "question": "the number is the task's own",
    "source": "the source to which it links says the number",
}


def find(text):
    """Return the numbers that are typed in a text, without those of EXCEPTIONS."""
    return tuple(match.group() for match in _NUMBER.finditer(_EXCEPTIONS.sub("", text)))
