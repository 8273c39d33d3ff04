# SPDX-License-Identifier: BSD-3-Clause
"""The reports as pages that need no other file, no script and no network: see templates/."""

from __future__ import annotations

import jinja2

from mrp_check.contract import resources
from mrp_check.contract.verdict import WORDS
from mrp_check.report import terminal
from mrp_check.rules import REQUIREMENTS

_TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(resources.folder("templates")),
    autoescape=True,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)


def render(template, **values):
    """Return the page that one of the templates makes of these values."""
    page = _TEMPLATES.get_template(template).render(values, requirements=REQUIREMENTS, words=WORDS)
    return terminal.plain(page)


def text(report):
    """Return the page of one package's report."""
    return render(
        "package.html",
        report=report,
        summary=terminal.summary(report),
        groups=terminal.with_consequences(report.findings),
        stages=terminal.by_stage(report),
        where=terminal.where,
        why_not=terminal.why_not,
        pages=terminal.pages,
        suppressed_line=terminal.suppressed_line,
        address_of=address_of,
    )


def address_of(page):
    """Return where a page of the tutorial can be opened, or "" if it cannot."""
    address = terminal.address_of(page)
    return address if "://" in address else ""
