# SPDX-License-Identifier: BSD-3-Clause
"""The checker's folders are layers: a module imports what stands below it, never what is above."""

import make_map
import pytest

pytestmark = pytest.mark.quick

# From the bottom up. Whatever runs with a student's code (confined) imports only itself.
LAYERS = (
    ("confined", "contract"),
    ("sandbox",),
    ("package",),
    ("code",),
    ("build",),
    ("run",),
    ("rules",),
    ("report",),
    ("verdict",),
    ("classroom",),
    ("learning",),
    ("cli",),
)
HEIGHT = {folder: height for height, folders in enumerate(LAYERS) for folder in folders}


def upward(graph):
    """Return (folder, what it imports) for each import from a higher layer, or beside it."""
    return [
        (folder, other)
        for folder, others in graph.items()
        for other in sorted(others)
        if HEIGHT[other] >= HEIGHT[folder]
    ]


def test_no_import_runs_upward():
    graph = make_map.imports()
    assert graph.keys() == HEIGHT.keys()
    assert upward(graph) == []


def test_an_import_upward_is_seen(tmp_path, monkeypatch):
    for name, text in {
        "contract/__init__.py": "",
        "contract/spec.py": "def read():\n    from mrp_check.rules import queue\n",
        "rules/__init__.py": "",
        "rules/queue.py": "from mrp_check.contract.spec import read\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(make_map, "CHECKER", tmp_path)
    assert upward(make_map.imports()) == [("contract", "rules")]
