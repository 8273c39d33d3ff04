# SPDX-License-Identifier: BSD-3-Clause
"""Makes a book of the pages, for Sphinx's builders `epub` and `latex`: see `make docs-book`.

In a book nothing can be chosen or opened. So each tab stands below its label, and what is folded
below its summary. Each picture is a file, in the colours of paper. The marks of proof are for
the site alone, and so is the list of the tests.
"""

import hashlib
import pathlib
import re
import subprocess

from docutils import nodes
from proofs import ListOfTests
from sphinx_inline_tabs._impl import TabContainer

BUILDERS = ("epub", "latex")
STYLE = pathlib.Path(__file__).resolve().parents[1] / "static" / "page.css"

_SVG = re.compile(r'<svg[^>]* viewBox="0 0 (\S+) (\S+)"[^>]*>(.*)</svg>', re.DOTALL)
_SUMMARY = re.compile(r"<details><summary>(.*)</summary>")


# Values of the theme, in light mode, which page.css uses and does not set.
_THEME = {
    "--color-foreground-primary": "#000000",
    "--color-background-secondary": "#f8f9fb",
    "--color-background-border": "#eeebee",
}


def style():
    """Return page.css's rules for pictures, with the values that it has in light mode."""
    text = STYLE.read_text()
    own = re.findall(r"^  (--[\w-]+): (#\w+);$", text.split("@media")[0], re.MULTILINE)
    values = {**_THEME, **dict(own)}
    rules = re.findall(r"^\.picture (?!svg)(.*})$", text, re.MULTILINE)
    flat = "\n".join(rules).replace(".picture ", "")
    return re.sub(r"var\((--[\w-]+)\)", lambda match: values[match[1]], flat)


def _picture(app, node):
    """Write a picture into files, one for each builder; return the node that shows them."""
    width, height, parts = _SVG.search(node.astext()).groups()
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}"><style>{style()}</style>{parts}</svg>'
    )
    name = hashlib.sha256(text.encode()).hexdigest()[:12]
    folder = pathlib.Path(app.doctreedir) / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    svg, pdf = folder / f"{name}.svg", folder / f"{name}.pdf"
    svg.write_text(text)
    subprocess.run(["rsvg-convert", "--format=pdf", f"--output={pdf}", svg], check=True)
    candidates = {"image/svg+xml": str(svg), "application/pdf": str(pdf)}
    for path in candidates.values():
        app.env.images.add_file(app.env.docname, path)
    return nodes.image(uri=str(svg), candidates=candidates, alt=node["alt"])


def _raw(app, node):
    """Return what stands in place of HTML."""
    summary = _SUMMARY.fullmatch(node.astext())
    if "alt" in node:
        return [_picture(app, node)]
    return [nodes.rubric(summary[1], summary[1])] if summary else []


def _make_book(app, doctree):
    if app.builder.name not in BUILDERS:
        return
    for node in list(doctree.findall(nodes.raw)):
        node.parent.replace(node, _raw(app, node))
    for node in list(doctree.findall(TabContainer)):
        label, content = node
        node.replace_self([nodes.rubric("", "", *label.children), *content.children])
    # Photographs of a screen, each in a light and a dark one, are for the site.
    for kind in (ListOfTests, nodes.figure):
        for node in list(doctree.findall(kind)):
            node.parent.remove(node)
    # A link by the name of a page's file leads nowhere here, as does one to no host.
    for node in list(doctree.findall(nodes.reference)):
        if re.fullmatch(r"[\w/]+\.html(#.*)?|\w+://", node.get("refuri", "")):
            node.replace_self(node.children)


def setup(app):
    # After the marks of proof are drawn (proofs.py).
    app.connect("doctree-read", _make_book, priority=600)
    return {"parallel_read_safe": False}
