# SPDX-License-Identifier: BSD-3-Clause
"""The functions of a Python source that rospy calls."""

from __future__ import annotations

import ast

from mrp_check.code.python_facts import argument
from mrp_check.code.python_source import Source


def callbacks(source: Source, **others: int) -> dict[ast.AST, set[ast.AST]]:
    """Return the callbacks of subscribers; and of each what it calls, and itself.

    others: what else of rospy's is handed a callback -> at which place
    """
    found: dict[ast.AST, set[ast.AST]] = {}
    places = {f"rospy.{name}": place for name, place in {"Subscriber": 2, **others}.items()}
    for call in source.nodes(ast.Call):
        place = places.get(source.dotted(call.func) or "")
        given = None if place is None else argument(call, place, "callback")
        function = source.definition(given or argument(call, place or 0, "handler"))
        if place is not None and isinstance(function, ast.FunctionDef):
            found[function] = {function, *source.called([function])}
    return found


def in_threads(source: Source) -> set[ast.AST]:
    """Return the functions that rospy calls in threads of its own, which end with the program."""
    called = callbacks(source, Service=2, Timer=1).values()
    return {function for one in called for function in one}
