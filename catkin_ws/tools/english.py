#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds what people read to plain English: the sentences of the pages, of README.md and of the
exercises, the comments and texts in Python files, and the lines of other sources.

A sentence of a page or of an exercise is at most 30 words long, and none has a word of ON_PAGES.
The reading grade (Flesch-Kincaid: years at school) of a page, and of a hint, is at most 9. Prints
the hardest page, and each fault with its file, its line, the sentence, and what to do. Exit code: 1
if there is a fault.
"""

import re
import subprocess
import sys
import tokenize

import pages
from pages import claims, evidence

# Debian has no textstat: tools/install_others.sh installs it for the same Python.
sys.path += map(str, (evidence.WORKSPACE / "build" / "lint").glob("lib/python3*/site-packages"))

MOST_WORDS = 30
MOST_GRADE = 9

# Words that are plain nowhere, and what to write in their place.
EVERYWHERE = {
    r"\bwithout a word\b": "say what is missing, such as 'and prints nothing'",
    r"\b(hence|thus|whereby|therein|thereof)\b": "write 'so', or begin another sentence",
    r"\bin order to\b": "write 'to'",
    r"\bupon\b": "write 'on'",
    r"\butili[sz]\w+": "write 'use'",
}
# In code they may be names, or short for what stands beside them.
ON_PAGES = {
    r"^Of [^,]{1,60},": "put the subject first, and then the verb",
    r"(?<!here )\bis none\b": "say what is not so: 'is not', 'does not count'",
    r"\bof which\b": "begin another sentence",
    r"\b(?i:whoever)\b": "name it, or write 'each ... that'",
    r"\bbesides\b": "write 'too', 'also' or 'apart from'",
    r"\bmend(s|ed|ing)?\b": "write 'fix'",
    r"\btold\b": "write 'reported', 'printed' or 'said'",
}
# What shows how something is wrong may say it in any words.
_NOT = (
    ":!tests/errata/original",
    ":!tests/test_claims.py",
    ":!tests/test_english.py",
    ":!tools/english.py",
)


def faults_of(text, habits, most_words=None):
    """Yield what to do about a text."""
    for habit, advice in habits.items():
        found = re.search(habit, text)
        if found:
            yield f"{found[0]!r}: {advice}"
    words = len(text.split())
    if most_words and words > most_words:
        yield f"{words} words, and {most_words} is the most: make two sentences of it"


def python_texts(path):
    """Yield (line, text) of each comment and each string in a Python file."""
    with tokenize.open(path) as file:
        for token in tokenize.generate_tokens(file.readline):
            if token.type in (tokenize.COMMENT, tokenize.STRING):
                yield token.start[0], " ".join(token.string.split())


def grades(sentences):
    """Return page -> its reading grade. Headings and the like are no sentences here."""
    import textstat  # what the tests of this file need not have

    texts = {}
    for one in sentences:
        if not one.heading:
            end = "" if one.text[-1] in ".!?" else "."
            texts.setdefault(one.page, []).append(one.text + end)
    return {page: textstat.flesch_kincaid_grade(" ".join(its)) for page, its in texts.items()}


def of_pages(sentences):
    """Yield each fault of the pages and of README.md."""
    for one in sentences:
        for fault in faults_of(one.text, {**EVERYWHERE, **ON_PAGES}, MOST_WORDS):
            yield f"{_file(one.page)}:{one.line}: {fault}\n    {one.text}"
    for page, grade in grades(sentences).items():
        if grade > MOST_GRADE:
            yield (
                f"{_file(page)}: its reading grade is {grade:.1f}, and {MOST_GRADE} is the most: "
                "write shorter sentences, and shorter words"
            )


def _file(page):
    path = evidence.ROOT / "README.md" if page == "README" else pages.DOC / f"{page}.rst"
    return path.relative_to(evidence.ROOT)


def of_exercises():
    """Yield each fault of the exercises' tasks and hints. Code counts as one word that is short."""
    import textstat

    for one in evidence.defects.exercises():
        task, hint = (" ".join(re.sub(r"`[^`]+`", "it", t).split()) for t in (one.task, one.hint))
        for sentence in re.split(r"(?<=[.:?]) ", f"{task} {hint}"):
            for fault in faults_of(sentence, {**EVERYWHERE, **ON_PAGES}, MOST_WORDS):
                yield f"{one.path.name}: {fault}\n    {sentence}"
        grade = textstat.flesch_kincaid_grade(hint)
        if grade > MOST_GRADE:
            yield f"{one.path.name}: its hint's reading grade is {grade:.1f}: shorten sentences"


def of_python():
    """Yield each fault of the Python files that git knows."""
    command = ["git", "ls-files", "--", "*.py", *_NOT]
    listed = subprocess.run(command, cwd=evidence.WORKSPACE, check=True, stdout=subprocess.PIPE)
    for name in listed.stdout.decode().split():
        for line, text in python_texts(evidence.WORKSPACE / name):
            for fault in faults_of(text, EVERYWHERE):
                yield f"catkin_ws/{name}:{line}: {fault}\n    {text}"


def of_others():
    """Yield each fault of the lines of launch files, C++ files, scripts, and heads of defects."""
    kinds = ("*.launch", "*.cpp", "*.h", "*.sh", "*.patch", "*.js")
    command = ["git", "ls-files", "--", *kinds, *_NOT, ":!src/mrp_check/correct"]
    listed = subprocess.run(command, cwd=evidence.WORKSPACE, check=True, stdout=subprocess.PIPE)
    for name in listed.stdout.decode().split():
        lines = (evidence.WORKSPACE / name).read_text(errors="replace").splitlines()
        for number, line in enumerate(lines, 1):
            for fault in faults_of(line, EVERYWHERE):
                yield f"catkin_ws/{name}:{number}: {fault}\n    {line.strip()}"


def main():
    sentences = [one for one in pages.build()[0] if one.typed]
    faults = [*of_pages(sentences), *of_exercises(), *of_python(), *of_others()]
    print("\n".join(faults), end="\n" if faults else "")
    grade, page = max((grade, page) for page, grade in grades(sentences).items())
    print(f"The hardest page to read: {claims.name_of(page)}, grade {grade:.1f}")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except pages.PagesError as error:
        sys.exit(f"error: {error}")
