# SPDX-License-Identifier: BSD-3-Clause
"""What a Python source proves to be wrong. What is only likely is left to later stages."""

from __future__ import annotations

import ast
import difflib

from mrp_check.contract.finding import NOTE
from mrp_check.rules.python_calls import Calls
from mrp_check.rules.python_messages import Messages
from mrp_check.rules.python_names import Names
from mrp_check.rules.python_rule import Rules, ast_text
from mrp_check.sources.python_modules import is_ros, resolve


def findings(package, source):
    """Yield findings about one source."""
    names, messages = Names(package, source), Messages(package, source)
    calls, statements = Calls(package, source), _Statements(package, source)
    imports = list(names.imports())
    undefined = list(names.undefined_names())
    for finding in undefined:
        # What was to be imported under its right name is not there under it, either.
        if difflib.get_close_matches(finding.expected, names.not_imported, 1, 0.6):
            finding.consequence_of = "python-names"
    found = [*imports, *undefined]
    for rule in (
        names.attributes,
        names.own_attributes,
        messages.unknown_fields,
        messages.unknown_arguments,
        calls.wrong,
        calls.too_early,
        statements.useless,
        statements.kept,
    ):
        found += rule()
    taken = {}
    for finding in found:
        # Of several findings about one line, the first is the cause.
        cause = taken.setdefault((finding.line, finding.severity), finding)
        if cause is not finding and finding.severity != NOTE:
            finding.consequence_of = cause.id
        yield finding


class _Statements(Rules):
    """Statements that do nothing, or do not keep what they make."""

    def useless(self):
        for node in ast.walk(self.source.tree):
            if not isinstance(node, ast.Expr) or not isinstance(
                node.value, (ast.Attribute, ast.Name)
            ):
                continue
            name = self.source.dotted(node.value)
            own = self.source.definition(node.value)
            of_ros = name and is_ros(name) and not self.is_own(name)
            found, missing = resolve(name) if of_ros else (None, "")
            is_function = missing is None and callable(found) or isinstance(own, ast.FunctionDef)
            if isinstance(node.value, ast.Attribute) and node.value.attr == "publish":
                is_function = True
            if is_function:
                text = ast_text(node.value)
                yield self.finding(
                    "spin"
                    if name == "rospy.spin"
                    else "node-start"
                    if not of_ros
                    else "python-names",
                    f"{text} is named here and not called: the brackets are missing.",
                    node,
                    expected=f"{text}()" if not text.endswith("publish") else f"{text}(...)",
                    fix=f"Write {text}() with brackets.",
                    change=(text, f"{text}()") if not text.endswith("publish") else None,
                )

    def kept(self):
        """A timer or a subscriber that nobody keeps works in rospy; but nobody can stop it."""
        for node in ast.walk(self.source.tree):
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                name = self.source.dotted(node.value.func)
                if name in ("rospy.Timer", "rospy.Subscriber"):
                    yield self.finding(
                        "lifetime",
                        f"What {name}() returns is not kept. rospy keeps it going all the same; but"
                        " nothing can stop it.",
                        node,
                        severity=NOTE,
                        expected="a member, such as self.timer or self.subscriber",
                        fix="Keep it as a member.",
                    )
