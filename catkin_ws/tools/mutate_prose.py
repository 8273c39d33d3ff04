#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Changes sentences of the pages and of the README, and counts how many changes the build finds.

Usage: mutate_prose.py check|record|builds

Each mutation changes one word of one sentence: a number, a negation, or a word into its opposite.
A sentence without such a word gets a "not".
The function that the build calls says whether the build would fail.

check: prints the score of each page, and what survives on the checked pages. Exit code 1 if the
    score is less than in the last row of prose_scores.csv.
record: appends the score to prose_scores.csv.
builds: makes some of the mutations in the files of a copy of the repository, and builds its pages
    each time. Exit code 1 if a build says something else than the function.
"""

import itertools
import pathlib
import random
import re
import sys
import tempfile
from typing import NamedTuple

import history
import pages
from mrp_testing.workspace import copy_repository
from pages import claims, evidence
from sentences import Sentence

HISTORY = evidence.WORKSPACE / "prose_scores.csv"
BUILDS = 10  # of checked pages, and as many of the others

_NUMBERS = "zero one two three four five six seven eight nine ten".split()
_OPPOSITES = """
oldest newest, old new, first last, before after, C++ Python, all none, every no, each no,
always never, more fewer, larger smaller, earlier later, early late, with without, same other,
both neither, publisher subscriber, publishers subscribers, publishes subscribes, sends receives,
gets loses, starts ends, begins ends, keeps drops, kept dropped, true false, can cannot, fast slow,
faster slower,
only also, left right, error warning, above below, inside outside, known unknown, enough little,
minutes seconds, passes fails, local global, relative absolute, full empty, longer shorter,
seldom often, alone together, up down
"""
_VERBS = "is are was were has have can does do must may will would should".split()


class Mutant(NamedTuple):
    """A sentence with one word changed, or with one more. begin, end: of what the word replaces."""

    index: int
    sentence: Sentence
    begin: int
    end: int
    new: str

    @property
    def text(self):
        old = self.sentence.text
        return old[: self.begin] + self.new + old[self.end :]


def _swaps():
    """Return word -> what it becomes."""
    swaps = dict(zip(_NUMBERS, [*_NUMBERS[1:], "eleven"]))
    for pair in _OPPOSITES.split(","):
        one, other = pair.split()
        swaps.setdefault(one, other)
        swaps.setdefault(other, one)
    swaps.update({verb: verb + " not" for verb in _VERBS})
    swaps.update({"not": "also", "no": "each", "none": "all", "cannot": "can"})
    return swaps


SWAPS = _swaps()
_WORD = re.compile(r"(?<![\w./~_-])(?:\d+|C\+\+|[A-Za-z]+)(?![\w/=_(-]|[.:]\w)")


def mutants(sentences):
    """Return all Mutants of the sentences that somebody has typed."""
    found = []
    for index, sentence in enumerate(sentences):
        if sentence.typed:
            words = [(match, _mutated(match.group())) for match in _WORD.finditer(sentence.text)]
            spans = [(*match.span(), new) for match, new in words if new]
            after_first_word = len(sentence.text.split()[0])
            for span in spans or [(after_first_word, after_first_word, " not")]:
                found.append(Mutant(index, sentence, *span))
    return found


def _mutated(word):
    """Return what a word becomes, or None."""
    if word.isdigit():
        return str(int(word) + 1)
    new = SWAPS.get(word) or SWAPS.get(word.lower())
    return new.capitalize() if new and word[0].isupper() and word != "C++" else new


def survivors(made, sentences, lists):
    """Return those of the mutants that no fault names, if the build finds them in the pages.

    It finds one mutant of each page at a time: pages do not share a list.
    """
    of_pages = {}
    for mutant in made:
        of_pages.setdefault(mutant.sentence.page, []).append(mutant)
    found = []
    for mutants_of_pages in itertools.zip_longest(*of_pages.values()):
        batch = [mutant for mutant in mutants_of_pages if mutant]
        changed = list(sentences)
        for mutant in batch:
            changed[mutant.index] = mutant.sentence._replace(text=mutant.text)
        faults = pages.faults(changed, lists)
        named = {text for fault in faults for text in (fault.page, fault.other)}
        found += [one for one in batch if not named & {one.text, one.sentence.text}]
    return found


def is_checked(mutant):
    return mutant.sentence.page not in pages.NOT_CHECKED


def score(sentences):
    """Print each page's score and the survivors; return (caught, all) of all pages."""
    lists = claims.read_lists(pages.LISTS)
    made = mutants(sentences)
    survived = survivors(made, sentences, lists)
    for page in dict.fromkeys(one.page for one in sentences):
        mine, left = (sum(one.sentence.page == page for one in some) for some in (made, survived))
        if mine:
            print(f"  {page:24} {mine - left:5} of {mine:5} caught")
    for mutant in filter(is_checked, survived):
        print(f"survived on {mutant.sentence.page}: {mutant.text}")
    print(f"{len(made) - len(survived)} of {len(made)} mutations caught")
    return len(made) - len(survived), len(made)


def fault(rows, percent):
    """Return a line on a score that has fallen, or None; rows: of prose_scores.csv."""
    before = history.last(rows)
    if not before or percent >= float(before["percent"]):
        return None
    return (
        f"error: expected a score of at least {before['percent']} %, as at {before['commit']}; "
        f"found {percent:.1f} %. Did a page come into pages_not_checked_yet? Call make claims."
    )


def main(action):
    sentences, said, code = pages.build()
    if code:
        return f"{said}\nerror: the pages do not build: correct them first"
    if action == "builds":
        return builds(sentences)
    caught, made = score(sentences)
    percent = round(100 * caught / made, 1)
    print(f"score: {percent} %")
    if action == "check":
        return fault(history.read(HISTORY), percent)
    row = {"commit": history.commit(), "caught": caught, "mutations": made, "percent": percent}
    history.append(HISTORY, [row])
    return None


def builds(sentences):
    """Make some mutations in files, and compare what the build says with what survivors() says."""
    lists = claims.read_lists(pages.LISTS)
    differ = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "copy"
        copy_repository(copy)
        for mutant in _chosen(mutants(sentences), copy):
            path = _file(mutant, copy)
            correct = path.read_text()
            path.write_text(_in_source(mutant, correct))
            _, said, code = pages.build(copy / pages.DOC.relative_to(evidence.ROOT))
            path.write_text(correct)
            expected = not survivors([mutant], sentences, lists)
            found = code != 0 and mutant.text in said
            differ += expected != found
            verdict = {True: "caught", False: "survived"}
            print(f"function: {verdict[expected]}, build: {verdict[found]}: {mutant.text}")
    return 1 if differ else None


def _chosen(made, copy):
    """Return mutants of checked and of other pages, by chance, but the same each time."""
    chance = random.Random(1)
    chosen = []
    for checked in (True, False):
        possible = [one for one in made if is_checked(one) == checked and _is_found(one, copy)]
        chosen += chance.sample(possible, min(BUILDS, len(possible)))
    return chosen


def _file(mutant, folder):
    page = mutant.sentence.page
    if page == "README":
        return folder / "README.md"
    return folder / pages.DOC.relative_to(evidence.ROOT) / f"{page}.rst"


def _is_found(mutant, copy):
    """Say whether the words around the mutated one stand in the page's file once.

    A heading does not count: with a line below it that is too short, it always fails the build.
    """
    return (
        not mutant.sentence.heading
        and len(_around(mutant).findall(_file(mutant, copy).read_text())) == 1
    )


def _around(mutant):
    text = mutant.sentence.text
    before, after = text[: mutant.begin].split()[-3:], text[mutant.end :].split()[:3]
    words = [*before, text[mutant.begin : mutant.end], *after]
    first, last = (r"\s+".join(map(re.escape, part)) for part in (before, after))
    old = re.escape(words[len(before)])
    gap = r"\s+" if text[: mutant.begin].endswith(" ") else ""
    return re.compile(f"({first}{gap}){old}(?=\\s*{last})")


def _in_source(mutant, text):
    return _around(mutant).sub(lambda match: match.group(1) + mutant.new, text)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in ("check", "record", "builds"):
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1]))
    except pages.PagesError as error:
        sys.exit(f"error: {error}")
