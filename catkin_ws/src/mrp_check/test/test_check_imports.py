# SPDX-License-Identifier: BSD-3-Clause
"""The checker's folders are layers: a module imports what stands below it, never what is above."""

import ast
import pathlib

import pytest

pytestmark = pytest.mark.quick

PACKAGE = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp_check"

# From the bottom up. Whatever runs with a student's code (confined) imports only itself.
LAYERS = (
    ("confined", "contract", "releases"),
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


def layer(module):
    """Return how high a module's folder stands, such as 2 for student.package."""
    folder = module.split(".")[0]
    return next(height for height, folders in enumerate(LAYERS) if folder in folders)


def imports(folder):
    """Return module -> modules of the package that it imports, anywhere in its text."""
    found = {}
    for path in folder.rglob("*.py"):
        if path.name == "__init__.py" and path.parent == folder:
            continue
        parts = path.relative_to(folder).with_suffix("").parts
        found[".".join(parts).replace(".__init__", "")] = set(imports_of(path, folder))
    return found


def imports_of(path, folder):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}:{node.lineno}: a relative import"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        for name in names:
            package, *parts = name.split(".")
            if package == "mrp_check":
                # What is imported from a module is no module itself.
                while parts and not is_module(folder.joinpath(*parts)):
                    parts.pop()
                yield ".".join(parts)


def is_module(path):
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


def upward(found):
    """Return (module, what it imports) for each import from a higher layer, or beside it."""
    return [
        (module, other)
        for module, others in sorted(found.items())
        for other in sorted(others)
        if layer(other) > layer(module)
        or layer(other) == layer(module)
        and other.split(".")[0] != module.split(".")[0]
    ]


def circle(found):
    """Return modules of which each imports the next, and the last the first; empty if none do."""
    done = set()

    def walk(module, path):
        if module in path:
            return path[path.index(module) :]
        if module in done:
            return []
        done.add(module)
        below = (walk(other, [*path, module]) for other in sorted(found.get(module, ())))
        return next((one for one in below if one), [])

    return next((one for one in (walk(module, []) for module in sorted(found)) if one), [])


def test_no_import_runs_upward():
    assert upward(imports(PACKAGE)) == []


def test_no_imports_run_in_a_circle():
    assert circle(imports(PACKAGE)) == []


def test_an_import_upward_and_a_circle_are_seen(tmp_path):
    for name, text in {
        "contract/spec.py": "def read():\n    from mrp_check.rules import queue\n",
        "rules/__init__.py": "",
        "rules/queue.py": "from mrp_check.contract.spec import read\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    found = imports(tmp_path)
    assert upward(found) == [("contract.spec", "rules.queue")]
    assert circle(found) == ["contract.spec", "rules.queue"]
