# SPDX-License-Identifier: BSD-3-Clause
"""Follows the links of the site that `make docs` builds. tests/browser/ opens it in a browser."""

import html.parser
import re
import urllib.parse

import pytest
from mrp_testing.workspace import ROOT, WORKSPACE
from mrp_view import findings

# One worker of pytest builds the site for these tests and for those of what the pages show.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("page")]


class Page(html.parser.HTMLParser):
    """The links of a page, and what they may lead to in it."""

    def __init__(self, path):
        super().__init__()
        self.links, self.ids = [], []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src"):
                self.links.append(value)
            elif name == "id":
                self.ids.append(value)


def broken_links(folder):
    """Return 'page: link' of every link that leads to no file of the site, or to no id in it."""
    pages = {path.resolve(): Page(path) for path in folder.rglob("*.html")}
    assert pages
    broken = []
    for path, page in pages.items():
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                continue
            name = urllib.parse.unquote(url.path)
            target = (path.parent / name).resolve() if name else path
            inside = folder.resolve() in target.parents and target.is_file()
            fragment = urllib.parse.unquote(url.fragment)
            if not inside or (fragment and fragment not in pages[target].ids):
                broken.append(f"{path.relative_to(folder.resolve())}: {link}")
    return broken


def test_every_link_within_the_site_leads_somewhere(site):
    assert broken_links(site) == []


def test_every_link_of_the_viewer_leads_somewhere(site):
    for link in findings.PAGES.values():
        page, _, fragment = link.partition("#")
        assert not fragment or fragment in Page(site / page).ids, link


def test_no_page_has_an_id_twice(site):
    for path in site.rglob("*.html"):
        ids = Page(path).ids
        assert {id_ for id_ in ids if ids.count(id_) > 1} == set(), path.name


@pytest.mark.quick
def test_broken_links_are_found(tmp_path):
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "there.html").write_text('<p id="here">')
    (tmp_path / "page.html").write_text(
        '<a href="b/there.html#here"><a href="#top" id="top"><a href="https://example.org/#x">'
        '<a href="b/there.html#gone"><a href="gone.html"><a href="#gone"><a href="/etc/passwd">'
        '<img src="gone.png"><a href="b">'
    )
    links = ["b/there.html#gone", "gone.html", "#gone", "/etc/passwd", "gone.png", "b"]
    assert broken_links(tmp_path) == [f"page.html: {link}" for link in links]


SOURCES = ("catkin_ws/src", "catkin_ws/tests", "docker", "README.md")
_CODE = re.compile(r"^ *\.\. (excerpt|file|literalinclude|code-block|original|ours):: (\S+)", re.M)


@pytest.mark.quick
def test_every_line_of_code_comes_from_a_file():
    """Pages hold commands only; their code comes from files, which the directives check.

    Only ci.rst shows what goes into the files of another repository.
    """
    doc = WORKSPACE / "src" / "mrp" / "doc"
    kinds = set()
    for page in (doc / "index.rst", *doc.glob("pages/*.rst")):
        text = page.read_text()
        assert not re.search(r"^(?! *\.\.).*::$", text, re.M), f"{page.name}: code in no directive"
        sources = dict.fromkeys(re.findall(r"^ +:source: (\S+)", text, re.M))
        for kind, name in _CODE.findall(text):
            kinds.add(kind)
            if kind == "code-block":
                is_typed = name == "bash" or page.name == "ci.rst"
                assert is_typed, f"{page.name}: code that somebody has typed"
            elif kind in ("excerpt", "literalinclude"):
                sources[name] = None
        for name in sources:
            path = (doc / name.lstrip("/")).resolve().relative_to(ROOT)
            assert str(path).startswith(SOURCES), f"{page.name}: {path}"
            assert doc.relative_to(ROOT) not in path.parents, f"{page.name}: {path}"
    assert {"excerpt", "file", "code-block", "original"} <= kinds
