# SPDX-License-Identifier: BSD-3-Clause
"""No statement, and no condition of a loop, names a function without calling it."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code.python_facts import argument
from mrp_check.code.python_modules import is_ros, resolve
from mrp_check.code.python_rule import PythonRule, ast_text, of_sources
from mrp_check.code.uses import without_comments
from mrp_check.contract.finding import CERTAIN, Finding
from mrp_check.contract.requirements import Rule

# A function that is named and not called is always true: the loop neither ends nor asks.
_OK = re.compile(r"\bros::ok\b(?!\s*\()")
_ENDLESS = "{0} is named here and not called: without brackets it is always true{1}."


class NotCalled(PythonRule):
    def findings(self) -> Iterator[Finding]:
        for loop in self.source.nodes(ast.While):
            parts = [node for node in ast.walk(loop.test) if isinstance(node, ast.Attribute)]
            called = [node.func for node in ast.walk(loop.test) if isinstance(node, ast.Call)]
            if any(self._is_shutdown(part) and part not in called for part in parts):
                yield self.finding(
                    "spin",
                    _ENDLESS.format("rospy.is_shutdown", ", and the loop does nothing"),
                    loop.test,
                    certainty=CERTAIN,
                    expected="while not rospy.is_shutdown():",
                    fix="Write rospy.is_shutdown() with brackets.",
                    change=("is_shutdown", "is_shutdown()"),
                )
        yield from self._statements()
        yield from self._tests_of_main()
        yield from self._never_main()
        yield from self._own_callbacks()
        yield from self._nothing()

    def _nothing(self) -> Iterator[Finding]:
        """Yield a finding if a program starts its node, and calls none of its functions."""
        calls = [*self.source.nodes(ast.Call)]
        own = [one for one in self.source.tree.body if isinstance(one, ast.FunctionDef)]
        named = {self.source.definition(node) for node in self.source.nodes(ast.expr)}
        lost = [one for one in own if one not in named]
        main = [call for call in calls if self.source.function(call) is self.source.tree]
        starts = [one for one in main if self.source.dotted(one.func) == "rospy.init_node"]
        others = [one for one in main if not _says_only(self.source.dotted(one.func) or "")]
        asks = {self.source.function(one) for one in calls if self.source.dotted(one.func)}
        for function in [one for one in lost if one in asks][:1]:
            if starts and not [one for one in others if one not in starts] and lost == own:
                yield self.finding(
                    "node-start",
                    f"{function.name}() is never called: the program starts its node, and ends.",
                    starts[0],
                    expected=f"{function.name}() after rospy.init_node()",
                    fix=f"Call {function.name}() below this line.",
                )

    def _own_callbacks(self) -> Iterator[Finding]:
        """Yield a finding if a callback is asked for within itself alone."""
        for call in self.source.nodes(ast.Call):
            callback = argument(call, 2, "callback")
            function = self.source.definition(callback)
            if self.source.dotted(call.func) != "rospy.Subscriber" or callback is None:
                continue
            named = self.source.nodes(ast.expr)
            others = [node for node in named if node is not callback and self._is(node, function)]
            if function and self.source.function(call) is function and not others:
                yield self.finding(
                    "callbacks",
                    f"The subscriber is made within {ast_text(callback)}(), which only it would"
                    " call: no message ever arrives.",
                    call,
                    expected="a subscriber that is made before the loop",
                    fix="Move this line out of the function, to below it.",
                )

    def _is(self, node: ast.expr, function: ast.AST | None) -> bool:
        is_read = isinstance(getattr(node, "ctx", None), ast.Load)
        return is_read and self.source.definition(node) is function

    def _tests_of_main(self) -> Iterator[Finding]:
        """Yield a finding if the program's start stands within a function that nobody calls."""
        called = {self.source.definition(node.func) for node in self.source.nodes(ast.Call)}
        for test in self.source.nodes(ast.Compare):
            function = self.source.function(test)
            if not isinstance(function, ast.FunctionDef) or function in called:
                continue
            if isinstance(test.left, ast.Name) and test.left.id == "__name__":
                yield self.finding(
                    "node-start",
                    f"This stands within {function.name}(), which nothing calls: Python reads the"
                    " functions, and ends.",
                    test,
                    expected="if __name__ == '__main__': outside of all functions",
                    fix="Indent it as far as the line with def.",
                )

    def _never_main(self) -> Iterator[Finding]:
        """Yield a finding if a program asks whether it is called by a name that is misspelt."""
        for test in self.source.nodes(ast.Compare):
            name = getattr(test.comparators[0], "value", None)
            is_asked = getattr(test.left, "id", "") == "__name__" and isinstance(
                test.ops[0], ast.Eq
            )
            if is_asked and isinstance(name, str) and name != "__main__" and "main" in name:
                yield self.finding(
                    "node-start",
                    f"__name__ is never {name!r}: Python reads the functions, and ends.",
                    test,
                    expected="if __name__ == '__main__':",
                    fix=f"Write __main__ for {name}.",
                    change=(name, "__main__"),
                )

    def _is_shutdown(self, node: ast.Attribute) -> bool:
        return self.source.dotted(node) == "rospy.is_shutdown"

    def _statements(self) -> Iterator[Finding]:
        for node in self.source.nodes(ast.Expr):
            if not isinstance(node.value, (ast.Attribute, ast.Name)):
                continue
            name = self.source.dotted(node.value)
            own = self.source.definition(node.value)
            of_ros = name is not None and is_ros(name) and not self.is_own(name)
            found, missing = resolve(name) if name and of_ros else (None, "")
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


def _says_only(name: str) -> bool:
    return name.startswith("rospy.log") or name == "print"


_of_python = of_sources(NotCalled)


def _findings(case: Case) -> Iterator[Finding]:
    yield from _of_python(case)
    for file in sorted({file for files in case.facts.sources.values() for file in files}):
        if case.package.kind(file) == "cpp":
            yield from _of_cpp(file, case.package.text(file))


def _of_cpp(file: str, text: str) -> Iterator[Finding]:
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        if _OK.search(line):
            yield Finding(
                "exit",
                _ENDLESS.format("ros::ok", ", also after Ctrl-C"),
                file,
                number,
                CERTAIN,
                expected="ros::ok()",
                seen=line.strip(),
                fix="Write ros::ok() with brackets.",
                change=("ros::ok", "ros::ok()"),
            )


RULE = Rule(
    stage="static",
    needs=("facts",),
    findings=_findings,
    also=("python-names", "node-start", "spin", "exit", "callbacks"),
)
