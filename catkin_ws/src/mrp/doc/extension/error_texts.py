# SPDX-License-Identifier: BSD-3-Clause
"""Directive `why`: each error text that has an entry, with its cause and its fix.

A heading is the text itself: so the site's search finds it, and leads to its place. The cause and
the fix are sentences of the page, which stand in its list.
"""

import itertools
import re
import sys

import cases
from listing import Generated

sys.path.append(str(cases.WORKSPACE / "tools"))
import why_entries as tool


class Why(Generated):
    def text(self):
        parts = []
        for theme, entries in itertools.groupby(tool.entries(), lambda entry: entry.theme):
            parts += [theme, "-" * len(theme), ""]
            parts += itertools.chain.from_iterable(map(_section, entries))
        for path in tool.FOLDER.glob("*.txt"):
            self.env.note_dependency(str(path))
        return "\n".join(parts)


def _section(entry):
    heading = _plain(tool.shown_on(entry.shows[0])[0])
    yield from (f".. _{entry.name}:", "", heading, "^" * len(heading), "")
    for text in entry.shows:
        yield from _block(tool.shown_on(text))
    if entry.also:
        yield from ("In other versions, or with other names:", "")
        yield from _block([line for text in entry.also for line in text.splitlines()])
    yield f"- **Why:** {_marked_up(entry.why)}"
    yield f"- **Fix:** {_marked_up(entry.fix)}"
    if entry.page:
        page, _, anchor = entry.page.partition("#")
        target = f"{page}.html#{anchor}" if anchor else f"{page}.html"
        yield f"- **More:** `{page.replace('_', ' ')} <{target}>`__"
    yield ""


def _block(lines):
    yield from (".. code-block:: text", "   :class: output", "")
    yield from ("   " + line for line in lines)
    yield ""


def _plain(text):
    """Return a text in which nothing is mark-up, and no address a link."""
    return re.sub(r"([\\*`|_]|:/|@)", r"\\\1", text)


def _marked_up(text):
    """Return a sentence in which `code` is code, and nothing else is mark-up."""
    parts = text.split("`")
    return "".join(f"``{part}``" if at % 2 else _plain(part) for at, part in enumerate(parts))


def setup(app):
    app.add_directive("why", Why)
    return {"parallel_read_safe": False}
