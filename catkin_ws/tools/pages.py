# SPDX-License-Identifier: BSD-3-Clause
"""The sentences of the pages, for tools: as `make docs` reads them."""

import json
import pathlib
import subprocess
import sys

DOC = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp" / "doc"
sys.path[:0] = [str(DOC / "extension"), str(DOC)]

import claims  # noqa: E402
import conf  # noqa: E402
import evidence  # noqa: E402
from sentences import Sentence  # noqa: E402

LISTS = DOC / "unproved"
NOT_CHECKED = conf.pages_not_checked_yet


class PagesError(Exception):
    """The pages cannot be read; the text is what Sphinx said."""


def build(doc=DOC):
    """Read all pages, and write none. Returns (sentences, what Sphinx said, its exit code).

    Only what has changed since is read again. Raises PagesError if a page cannot be read.
    """
    folder = doc.parents[2] / "build" / "sentences"
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "dummy", doc, folder],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    result = folder / "sentences.json"
    if done.returncode not in (0, 1) or not result.exists():
        raise PagesError(done.stdout)
    return read(result), done.stdout, done.returncode


def read(path):
    """Return the sentences in a file sentences.json."""
    found = [Sentence(**one) for one in json.loads(path.read_text())]
    return [one._replace(proofs=tuple(one.proofs)) for one in found]


def faults(sentences, lists=None):
    """Return the faults of these sentences, as the build of the pages finds them; but those of
    their order, which claims.moved() finds.

    lists: what claims.read_lists returns, if it is known already
    """
    lists = lists or claims.read_lists(LISTS)
    return claims.check(sentences, evidence.all_tests(), lists, NOT_CHECKED)
