# SPDX-License-Identifier: BSD-3-Clause
"""The report as one page that needs no other file, no script and no network."""

from __future__ import annotations

import html
import pathlib

from mrp_check.contract.finding import ERROR
from mrp_check.contract.requirements import STAGES
from mrp_check.contract.verdict import BROKEN, FINDINGS, MET, UNCHECKED
from mrp_check.report import console
from mrp_check.rules import REQUIREMENTS

_SITE = pathlib.Path(__file__).resolve().parents[5] / "build" / "docs"
_WORDS = {MET: "met", BROKEN: "not met", UNCHECKED: "not checked"}

STYLE = """
:root { color-scheme: light dark; --text: #1c2126; --faint: #56606a; --back: #ffffff;
  --card: #f5f7f9; --line: #cfd6dd; --met: #1a6b34; --broken: #a61b1b; --unchecked: #7a5400;
  --link: #0b57a4; }
@media (prefers-color-scheme: dark) { :root { --text: #e6e9ec; --faint: #a7b0b9; --back: #15191d;
  --card: #1e242a; --line: #3a434c; --met: #72d08f; --broken: #ff8f8f; --unchecked: #e9bd5b;
  --link: #86bdf7; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 1.5rem 1rem 4rem; background: var(--back);
  color: var(--text); font: 1rem/1.55 system-ui, sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; }
h3 { font-size: 1rem; margin: 0 0 .5rem; overflow-wrap: anywhere; }
a { color: var(--link); }
.faint { color: var(--faint); }
.verdict { display: inline-block; margin: .8rem 0 0; padding: .3rem .8rem; border: 2px solid;
  border-radius: .4rem; font-weight: 600; }
.met { color: var(--met); } .broken, .error { color: var(--broken); }
.unchecked, .warning { color: var(--unchecked); } .note { color: var(--faint); }
table { border-collapse: collapse; width: 100%; }
caption { text-align: left; font-weight: 600; padding: .9rem 0 .3rem; }
th, td { text-align: left; vertical-align: top; padding: .35rem .6rem .35rem 0;
  border-top: 1px solid var(--line); font-weight: normal; }
td { white-space: nowrap; width: 8rem; font-weight: 600; }
article { background: var(--card); border: 1px solid var(--line); border-radius: .5rem;
  padding: .9rem 1rem; margin: 0 0 1rem; }
article.error { border-left: .35rem solid var(--broken); color: inherit; }
article.warning { border-left: .35rem solid var(--unchecked); color: inherit; }
article.note { border-left: .35rem solid var(--line); color: inherit; }
article p { margin: 0 0 .6rem; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: 6rem 1fr; gap: .3rem .8rem; margin: 0; }
dt { color: var(--faint); } dd { margin: 0; min-width: 0; }
code, pre { font: .88rem/1.5 ui-monospace, monospace; white-space: pre-wrap;
  overflow-wrap: anywhere; margin: 0; }
details { margin-top: .8rem; } summary { cursor: pointer; }
details article { margin: .8rem 0 0; background: var(--back); }
@media (max-width: 34rem) { dl { grid-template-columns: 1fr; } dd { margin-bottom: .4rem; }
  td { width: auto; } }
@media print { body { max-width: none; } article { break-inside: avoid; } }
"""


def text(report):
    name = _escaped(report.package or "no package")
    body = _body(report)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<title>{name}: what the checker found</title>
<style>{STYLE}</style>
</head>
<body>
<header>
<h1>{name}</h1>
{body}
</main>
</body>
</html>
"""


def _body(report):
    classes = {MET: "met", FINDINGS: "broken", UNCHECKED: "unchecked"}
    parts = [
        f'<p class="faint">{_escaped(report.spec)}</p>',
        f'<p class="verdict {classes[report.verdict]}">{_escaped(console.summary(report))}</p>',
        "</header>",
        "<main>",
        f"<p>{_escaped(report.reason)}</p>",
    ]
    ordered = console.in_order(report.findings)
    ids = {cause.id for cause in ordered if not cause.consequence_of and cause.severity == ERROR}
    told = set()
    if ordered:
        parts.append("<h2>What was found</h2>")
    for finding in ordered:
        if finding.consequence_of in ids:
            continue
        following = []
        if finding.severity == ERROR and not finding.consequence_of and finding.id not in told:
            told.add(finding.id)
            following = [f for f in ordered if f.consequence_of == finding.id]
        parts.append(_article(finding, report, following))
    parts.append("<h2>All requirements</h2>" if report.requirements else "")
    for stage in STAGES:
        rows = [id_ for id_ in report.requirements if REQUIREMENTS[id_].stage == stage]
        if rows:
            parts.append(f"<table><caption>{stage}</caption>")
            parts += [_row(id_, report) for id_ in rows]
            parts.append("</table>")
    return "\n".join(parts)


def _row(id_, report):
    requirement, verdict = REQUIREMENTS[id_], report.requirements[id_]
    why = _escaped(console.why_not(report, id_))
    return (
        f'<tr><td class="{verdict}">{_WORDS[verdict]}</td>'
        f'<th scope="row">{_escaped(requirement.title)}'
        f' <span class="faint">{id_}{why}</span></th></tr>'
    )


def _article(finding, report, following=()):
    where = _escaped(console.where(finding, report))
    parts = [
        f'<article class="{finding.severity}">',
        f'<h3><span class="{finding.severity}">{finding.severity}</span> <code>{where}</code></h3>',
        f"<p>{_escaped(finding.message)}</p>",
        "<dl>",
    ]
    for name in ("expected", "seen", "fix"):
        value = getattr(finding, name)
        if value:
            tag = "pre" if "\n" in value or name != "fix" else "span"
            parts.append(f"<dt>{name}</dt><dd><{tag}>{_escaped(value)}</{tag}></dd>")
    if finding.consequence_of:
        parts.append(f"<dt>follows from</dt><dd>{finding.consequence_of}</dd>")
    else:
        parts.append(f"<dt>page</dt><dd>{_link(finding.id)}</dd>")
    parts.append("</dl>")
    if following:
        parts.append(f"<details><summary>What follows from it: {len(following)}</summary>")
        parts += [_article(one, report) for one in following]
        parts.append("</details>")
    return "\n".join([*parts, "</article>"])


def _link(id_):
    """Return the page that explains a requirement: a link where the pages have been built."""
    page = REQUIREMENTS[id_].page
    if (_SITE / page.split("#")[0]).is_file():
        path, _, anchor = page.partition("#")
        address = (_SITE / path).as_uri() + (f"#{anchor}" if anchor else "")
        return f'<a href="{_escaped(address)}">{_escaped(page)}</a>'
    return f"<code>{_escaped(page)}</code>"


def _escaped(text):
    return html.escape(console.plain(text))
