# SPDX-License-Identifier: BSD-3-Clause
"""Holds the sentences of the pages against the tests that prove them, and against the lists.

Each sentence of a page is one of two:

- proved: it is marked with a test, and the test quotes it word for word;
- listed: it stands in unproved/PAGE.txt, word for word, under the reason why no test proves it.

A true sentence at a wrong place is false, such as the explanation of another term. So each list
ends with the order of all that stands on its page, each as the first digits of its SHA-1.

So no sentence, no quote and no list can change alone: what does not fit together is a Fault, which
fails the build of the pages.
"""

import difflib
import hashlib
import itertools
import textwrap
from typing import NamedTuple

import typed_numbers
from sentences import plain

REASONS = {
    "heading": "names what stands below or beside it",
    "instruction": "says what to do",
    "definition": "says what a word means",
    "guide": "says what a page is for, what it shows, or where to read on",
    "question": "asks the reader",
    "opinion": "advises or judges",
    "source": "is taken from the source to which it links",
    "entry": "is the cause or the fix of an error text: its entry has the commands that print it",
    "open": "claims something that no test proves yet",
}


_ORDER = "order"


class Fault(NamedTuple):
    """What does not fit together.

    kind: a key of MESSAGES
    where: (page, line), or the file and the line as "FILE:LINE"
    page: the sentence as the page has it, or ""
    other: what the test quotes, or the list has, in its place, or ""
    proof: the name of the test, or ""
    """

    kind: str
    where: object
    page: str = ""
    other: str = ""
    proof: str = ""

    def text(self, tests):
        """Return the fault in words: what was found, both texts, and what to do."""
        lines = [MESSAGES[self.kind].format(proof=self.proof)]
        other = "test" if self.proof else "list"
        lines += [f"    page: {self.page}"] if self.page else []
        lines += [f"    {other}: {self.other}"] if self.other else []
        if self.proof in tests:
            lines.append(f"    file: {tests[self.proof].file}, line {tests[self.proof].line}")
        return "\n".join(lines)


MESSAGES = {
    "no such proof": "There is no test {proof}: correct the mark. See extension/evidence.py.",
    "not quoted": "The test {proof} does not quote this sentence. Does it prove it? Then "
    "'make claims WRITE=1' writes the quote. Otherwise change the page or the test.",
    "not marked": "The test {proof} quotes a sentence that no page marks with it. Correct the "
    "quote or the page, or delete the quote.",
    "other language": "The sentence stands in the tab of one language, and {proof} is of the "
    "other one. Name a test of this language.",
    "not listed": "No test proves this sentence, and the list of its page does not have it. Mark "
    "it with its test, or write it into the list under a reason.",
    "not on the page": "The list of unproved sentences has a sentence that the page does not "
    "have. Correct it or delete it.",
    "listed and proved": "This sentence has a proof: delete it from the list of its page.",
    "no link": "The list says that this sentence is taken from a source. Put the link into the "
    "sentence, or give another reason.",
    "typed number": "This sentence has a number that is typed, and no test proves it. Take the "
    "number from where it is defined (extension/value.py), or leave it out.",
    "moved": "This stood at another place, or something else stood here. Is all around it true? "
    "Then 'make claims WRITE=1' keeps the new order.",
    "no such page": "No page has this name: delete its list of unproved sentences.",
    "no such reason": f"The list gives an unknown reason. Expected one of: {', '.join(REASONS)}.",
}


def name_of(page):
    """Return the name of a page's list, without its ending."""
    return page.split("/")[-1]


def _place(name):
    return f"unproved/{name}.txt:1"


def read_list(path):
    """Return sentence -> reason, of a list. There is a heading in brackets for each reason."""
    listed, reason = {}, ""
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.startswith("["):
            reason = line.strip("[]")
        elif line and not line.startswith("#") and reason != _ORDER:
            listed[plain(line)] = reason
    return listed


def read_order(path):
    """Return the digits of the page's order, which stand last in a list. [] without them."""
    text = path.read_text() if path.exists() else ""
    return text.partition(f"[{_ORDER}]")[2].split()


def order(sentences):
    """Return (Sentence, digits) of all that has its place on a page."""
    texts = ((one, one.text if one.typed else one.placed) for one in sentences)
    return [(one, hashlib.sha1(text.encode()).hexdigest()[:4]) for one, text in texts if text]


def read_lists(folder):
    """Return name of a page -> what read_list returns, of all lists in a folder."""
    return {path.stem: read_list(path) for path in sorted(folder.glob("*.txt"))}


def write_list(path, page, listed, digits=()):
    """Write a list: sentence -> reason, in the order in which they are to stand; and the order of
    the page."""
    parts = [
        f"# The sentences of {page} that no test proves, word for word: see extension/claims.py."
    ]
    for reason in REASONS:
        lines = [sentence for sentence, its in listed.items() if its == reason]
        if lines:
            parts.append("\n".join([f"[{reason}]", *lines]))
    parts.append("\n".join([f"[{_ORDER}]", *textwrap.wrap(" ".join(digits), 99)]))
    path.write_text("\n\n".join(parts) + "\n")


def check(sentences, tests, lists, not_checked):
    """Return the faults of all pages.

    sentences: of all pages, see sentences.py
    tests: proof -> Test, see evidence.py
    lists: name of a page -> sentence -> reason
    not_checked: the names of pages whose sentences need not be quoted or listed yet
    """
    typed = [one for one in sentences if one.typed]
    checked = [one for one in typed if one.page not in not_checked]
    return [
        *(
            Fault("no such proof", (one.page, one.line), one.text, "", proof)
            for one in sentences
            for proof in one.proofs
            if proof not in tests
        ),
        *_quotes(typed, checked, tests),
        *(fault for one in checked for fault in _language(one, tests)),
        *_lists(checked, lists),
        *(
            Fault("no such page", _place(name))
            for name in lists
            if name not in {name_of(one.page) for one in typed}
        ),
    ]


def _quotes(typed, checked, tests):
    """Hold what pages mark against what tests quote."""
    marked = {(proof, one.text) for one in typed for proof in one.proofs}
    stale = {
        proof: [quote for quote in test.quotes if (proof, quote) not in marked]
        for proof, test in tests.items()
    }
    for one in checked:
        for proof in one.proofs:
            if proof in tests and one.text not in tests[proof].quotes:
                old = nearest(one.text, stale[proof])
                stale[proof] = [quote for quote in stale[proof] if quote != old]
                yield Fault("not quoted", (one.page, one.line), one.text, old, proof)
    for proof, quotes in stale.items():
        for quote in quotes:
            where = f"{tests[proof].file}:{tests[proof].line}"
            yield Fault("not marked", where, "", quote, proof)


def moved(sentences, folder, faults):
    """Return the first fault of the order on each page that has no other fault.

    sentences, faults: of all pages; folder: that of the lists
    """
    wrong = {one.where[0] for one in faults if isinstance(one.where, tuple)}
    for page in dict.fromkeys(one.page for one in sentences):
        kept = read_order(folder / f"{name_of(page)}.txt")
        mine = order(one for one in sentences if one.page == page)
        pairs = itertools.zip_longest(mine, kept, fillvalue=(None, ""))
        other = next((one for one, old in pairs if one[1] != old), None)
        if kept and other and page not in wrong:
            one = other[0] or mine[-1][0]
            yield Fault("moved", (page, one.line), one.text if one.typed else one.placed)


def _language(sentence, tests):
    """Find a sentence in one language's tab that only the other language's tests prove."""
    languages = {tests[proof].language for proof in sentence.proofs if proof in tests}
    if sentence.language and languages and not languages & {"", sentence.language}:
        where = (sentence.page, sentence.line)
        yield Fault("other language", where, sentence.text, "", sentence.proofs[0])


def _lists(checked, lists):
    """Hold what pages do not mark against their lists."""
    for page in dict.fromkeys(one.page for one in checked):
        mine = [one for one in checked if one.page == page]
        listed = lists.get(name_of(page), {})
        texts = {one.text for one in mine}
        gone = [sentence for sentence in listed if sentence not in texts]
        for one in mine:
            where = (page, one.line)
            reason = listed.get(one.text)
            if reason is None and not one.proofs:
                old = nearest(one.text, gone)
                gone = [sentence for sentence in gone if sentence != old]
                yield Fault("not listed", where, one.text, old)
            elif reason is not None and one.proofs:
                yield Fault("listed and proved", where, one.text)
            elif one.numbers and not one.proofs and reason not in typed_numbers.FREE:
                yield Fault("typed number", where, one.text, ", ".join(one.numbers))
            elif reason == "source" and not one.linked:
                yield Fault("no link", where, one.text)
            elif reason is not None and reason not in REASONS:
                yield Fault("no such reason", where, one.text, reason)
        for sentence in gone:
            yield Fault("not on the page", _place(name_of(page)), "", sentence)


def nearest(text, others):
    """Return the one of the others that is most like a text, or "" if none is like it."""
    return next(iter(difflib.get_close_matches(text, others, 1)), "")


def counts(sentences, lists, not_checked):
    """Return what -> how many sentences of the checked pages are so, for a line of the build."""
    checked = [one for one in sentences if one.typed and one.page not in not_checked]
    found = {"proved": sum(bool(one.proofs) for one in checked)}
    for reason in REASONS:
        listed = {
            (name, text) for name, its in lists.items() for text in its if its[text] == reason
        }
        found[reason] = sum((name_of(one.page), one.text) in listed for one in checked)
    return found
