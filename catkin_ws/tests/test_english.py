# SPDX-License-Identifier: BSD-3-Clause
"""What `make lint` finds in the English of pages, and what it leaves alone."""

import sys

import pytest
from mrp_testing.workspace import WORKSPACE

sys.path.insert(0, str(WORKSPACE / "tools"))

import english

pytestmark = pytest.mark.slow

WRONG = {
    "Of the messages, the oldest are dropped.": "subject first",
    "A figure from a busy machine is none.": "say what is not so",
    "There are two nodes, one of which prints.": "another sentence",
    "Whoever subscribes later hears it.": "name it",
    "What runs besides is slower.": "apart from",
    "This mends it.": "write 'fix'",
    "The error is told.": "reported",
    "It ends without a word.": "what is missing",
    "The language decides upon it.": "write 'on'",
    "word " * 31: "make two sentences",
}
RIGHT = [
    "The first of the messages is dropped.",
    "There is none.",
    "Of course.",
    "It may amend the list.",
    "word " * 30,
]


def faults(text):
    habits = {**english.EVERYWHERE, **english.ON_PAGES}
    return list(english.faults_of(text, habits, english.MOST_WORDS))


@pytest.mark.parametrize("text", WRONG)
def test_habit_is_found(text):
    (fault,) = faults(text)
    assert WRONG[text] in fault


@pytest.mark.parametrize("text", RIGHT)
def test_plain_text_is_not(text):
    assert faults(text) == []


def test_python_comments_and_texts_are_read(tmp_path):
    path = tmp_path / "one.py"
    path.write_text('upon = 1  # upon that\n\n\ntext = """A\n   text"""\n')
    assert list(english.python_texts(path)) == [(1, "# upon that"), (4, '"""A text"""')]
