# SPDX-License-Identifier: BSD-3-Clause
"""What the original page prints, as a package, and what mends it so far that its nodes start."""

from mrp_testing.workspace import WORKSPACE

ORIGINAL = WORKSPACE / "tests" / "errata" / "original"
PACKAGE = "my_robotics_pkg"

# What is wrong in its code (E) and in its text (P), as the page "Errata" counts it.
NUMBERS = [*(f"E{n}" for n in range(1, 22)), *(f"P{n}" for n in range(1, 21))]

# What keeps its nodes from starting, as (file, what it says, what it should say).
MENDS = {
    "e01_global": [
        ("src/publisher_py_node.py", "global this_nodes_namespace", "this_nodes_namespace"),
        ("src/subscriber_py_node.py", "global this_nodes_namespace", "this_nodes_namespace"),
    ],
    "e03_parenthesis": [("src/subscriber_py_node.py", "str(this_data)", "str(this_data))")],
    "e12_interpreter": [
        ("src/publisher_py_node.py", "/usr/bin/env python", "/usr/bin/python3"),
        ("src/subscriber_py_node.py", "/usr/bin/env python", "/usr/bin/python3"),
    ],
}
STARTS = tuple(MENDS)


def mend(package, *names):
    """Make some of MENDS in a copy of the original."""
    for name in names:
        for file, old, new in MENDS[name]:
            replace(package / file, old, new)


def replace(path, old, new):
    """Replace the one place in a file that has the text `old`."""
    text = path.read_text()
    assert text.count(old) == 1, f"{old!r} in {path}"
    path.write_text(text.replace(old, new))
