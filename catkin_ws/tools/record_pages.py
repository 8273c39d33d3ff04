#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does what the pages say, and records what they show of it.

Usage: record_pages.py [PAGE]
Writes into src/mrp/doc/recorded/ what the commands print, and the graphs. With a PAGE, such as
latch, it writes what that page shows, and does only the steps that the page needs. What differs
from the record in nothing but times, values and the like keeps its old text.
"""

import json
import re
import sys
import tempfile

import run_page
from run_page import RECORDED, StepError, meaning, page_of, pages_of

# How many lines are left out differs from run to run.
_LEFT_OUT = re.compile(r"\[\d+ other lines? left out\]")


# Numbers, but not those of "38 of 38"; and those at the end of a name that is anonymous: of a
# process, which may be a small one, and of a time.
_NUMBERS = re.compile(
    r"(?<![\w.])(?<!\d of )-?\d+(\.\d+)?(?=s?(?!\w))(?! of \d)|(?<=_)(\d+(?=_\d{4,})|\d{4,})"
)


def masked(lines):
    """Return the lines, with what differs from run to run as #: times, process ids, ports, values.

    Lines of several nodes come in any order, and more or fewer of a kind: so it is a set.
    """
    # Debian 13's env leaves out its folder, and the language decides the quotes.
    text = "\n".join(lines).replace("/usr/bin/env:", "env:").translate(str.maketrans("‘’", "''"))
    lines = [line for line in text.splitlines() if not _LEFT_OUT.fullmatch(line)]
    return {_NUMBERS.sub("#", line) for line in lines}


def differences(recorded, shown, printed):
    """Return the masked lines in which an output differs from what is recorded of it.

    shown, printed: what the page shows of the output, and all of it
    """
    # A node that is slow to start has a line of each kind, too; perhaps not with the first numbers,
    # to which the page keeps. So what the page chooses of an output may have another kind today.
    more = masked(shown) - masked(recorded) if masked(shown) == masked(printed) else set()
    return more | (masked(recorded) - masked(printed))


def says_what_is_left_out(lines):
    return any(map(_LEFT_OUT.fullmatch, lines))


def renewed(recorded, shown, to_do, page=None):
    """Return what recorded/outputs.json and graphs.json are to have.

    recorded: what they have, as a pair
    shown: run_page.Shown of to_do
    page: only what this page shows is renewed; without it all, and what no page shows any more goes
    """
    outputs, graphs = recorded
    names = {
        step.get(kind)
        for step in to_do
        for kind in ("output", "graph")
        if page in (None, page_of(step))
    }
    shows = {
        step["output"]: step.get("shows", "").splitlines() for step in to_do if "output" in step
    }

    def is_kept(name, lines):
        old = outputs.get(name, [])
        return (
            not differences(old, lines, shown.printed[name])
            and not meaning.missing(shows[name], old)
            and says_what_is_left_out(old) == says_what_is_left_out(lines)
        )

    new = {
        name: outputs[name] if is_kept(name, lines) else lines
        for name, lines in shown.outputs.items()
        if name in names
    }
    new_graphs = {name: graph for name, graph in shown.graphs.items() if name in names}
    return ({**outputs, **new}, {**graphs, **new_graphs}) if page else (new, new_graphs)


def record(page=None):
    """Do the steps of all pages or of one, and write what they print into recorded/."""
    with tempfile.TemporaryDirectory() as site, tempfile.TemporaryDirectory() as home:
        run_page.build(site, "-D", "recording=1")
        to_do = run_page.steps(site)
        if page not in (None, *pages_of(to_do)):
            raise StepError(f"expected a page of {', '.join(pages_of(to_do))}; found {page}")
        shown = run_page.read(to_do, home, say=print, only=page)
    files = [RECORDED / "outputs.json", RECORDED / "graphs.json"]
    recorded = [json.loads(file.read_text()) for file in files]
    for file, found in zip(files, renewed(recorded, shown, to_do, page)):
        text = json.dumps(found, indent=1, sort_keys=True, ensure_ascii=False)
        file.write_text(text + "\n")


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    try:
        record(*sys.argv[1:])
    except StepError as error:
        sys.exit(f"error: {error}")
