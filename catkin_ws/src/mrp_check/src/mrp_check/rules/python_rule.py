# SPDX-License-Identifier: BSD-3-Clause
"""What all rules about a Python source have in common."""

from __future__ import annotations

import ast
import difflib

from mrp_check.contract.finding import Finding
from mrp_check.sources.python_modules import is_ros, resolve


class Rules:
    """Rules about one source."""

    def __init__(self, package, source):
        self.package = package
        self.source = source
        self.file = source.file

    def finding(self, id_, message, node, **more):
        line = node if isinstance(node, int) else node.lineno
        more.setdefault("seen", self.package.lines(self.file)[line - 1].strip())
        return Finding(id_, message, self.file, line, **more)

    def is_own(self, name):
        """Return whether a module is the package's own (made, or generated of its messages)."""
        top = name.split(".")[0]
        paths = {p for p in self.package.of_kind("python")}
        return top == self.package.name or any(
            path.endswith((f"/{top}.py", f"/{top}/__init__.py"))
            or path == f"{top}.py"
            or f"/{top}/" in f"/{path}"
            for path in paths
        )

    def message_class(self, node):
        """Return the class of a message that an expression names, or None."""
        name = self.source.dotted(node) if isinstance(node, (ast.Name, ast.Attribute)) else None
        if not name or ".msg." not in name or not is_ros(name) or self.is_own(name):
            return None
        found, missing = resolve(name)
        return found if missing is None and hasattr(found, "__slots__") else None

    def written(self, node):
        """Return an expression as it is written."""
        return ast.get_source_segment(self.package.text(self.file), node)


def nearest(name, names, alike=0.6):
    """Return (the name that is most like it, a hint that says so), or (None, "")."""
    found = difflib.get_close_matches(name, list(names), 1, alike)
    return (found[0], f" Perhaps {found[0]} is meant.") if found else (None, "")


def ast_text(node):
    """Return the source of a short expression."""
    if isinstance(node, ast.Attribute):
        return f"{ast_text(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else "..."
