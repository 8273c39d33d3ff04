# SPDX-License-Identifier: BSD-3-Clause
"""An error was seen, or a named rule of ROS, CMake or Python says so; nothing else is one."""

import ast
import pathlib

import pytest
from mrp_check import rules
from mrp_check.code.facts import Facts
from mrp_check.contract.finding import CERTAIN, HABIT, HINT, READ, SEEN, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.verdict import causes
from mrp_check.verdict.severity import severity, weigh

pytestmark = pytest.mark.quick

SOURCES = pathlib.Path(rules.__file__).parents[1]
FILES = sorted(pathlib.Path(rules.__file__).parent.rglob("[a-z]*.py"))


@pytest.mark.parametrize(
    ("certainty", "with_contract", "without"),
    [
        (SEEN, "error", "error"),
        (CERTAIN, "error", "error"),
        (READ, "error", "warning"),
        (HABIT, "warning", "warning"),
        (HINT, "note", "note"),
    ],
)
def test_a_certainty_has_one_severity(certainty, with_contract, without):
    assert [severity(certainty, has) for has in (True, False)] == [with_contract, without]


@pytest.mark.parametrize("rule", rules.RULES, ids=lambda rule: rule.findings.__module__)
@pytest.mark.parametrize("has_contract", [True, False])
def test_a_habit_never_becomes_an_error(rule, has_contract):
    """Not even next to the same fault that was seen, whatever the rule."""
    habits = [Finding(id_, "It works.", "a.py", 1, HABIT) for id_ in rule.ids]
    seen = [Finding(id_, "It fails.", "a.py", 1, SEEN) for id_ in rule.ids]
    habits = [*Rule(rule.stage, (), lambda case: habits, also=rule.ids).ask(None)]
    for finding in (*seen, *habits):
        finding.stage, finding.severity = rule.stage, severity(finding.certainty, has_contract=True)
    known = causes.without_repeats([*habits, *seen], None, None, has_contract)
    weigh(known, has_contract)
    assert {habit.severity for habit in habits} == {"warning"}


def test_what_follows_from_a_warning_of_the_same_rule_counts():
    """It was called its own consequence: the exit code was 1, next to "Errors: 0"."""
    module = Finding("python-names", "There's no module.", "a.py", 1, READ)
    name = Finding("python-names", "There's no name.", "a.py", 9, CERTAIN)
    name.consequence_of = module.id
    weigh([module, name], has_contract=False)
    assert (module.severity, name.severity, name.consequence_of) == ("warning", "error", None)


def test_what_follows_from_a_consequence_is_one():
    ids = {"targets": None, "starts": "targets", "exit": "starts"}
    chain = [Finding(id_, "It fails.", certainty=SEEN, consequence_of=ids[id_]) for id_ in ids]
    weigh(chain, has_contract=True)
    assert [finding.consequence_of for finding in chain] == [*ids.values()]


def _certainties(path):
    """Yield each certainty that a rule of the files, or of the sources, names."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Name) and node.id in ("SEEN", "CERTAIN", "READ", "HABIT", "HINT"):
            yield node.id


@pytest.mark.parametrize(
    "path", [p for p in FILES if p.parent.name in ("code", "tools")], ids=lambda path: path.stem
)
def test_what_is_only_read_is_not_said_to_be_seen(path):
    assert "SEEN" not in _certainties(path)


def test_what_was_only_read_is_an_error_where_it_was_seen():
    read = [Finding("spin", "It says so.", file, 1, READ) for file in ("a.py", "b.py")]
    weigh([*read, Finding("spin", "It fails.", "a.py", 9, SEEN)], has_contract=False)
    assert [finding.severity for finding in read] == ["error", "warning"]


@pytest.mark.parametrize(("cause", "severity"), [("targets", "error"), ("python-names", "warning")])
def test_only_what_fails_because_of_it_confirms_what_was_read(cause, severity):
    """A name that Python lacks is seen as such; a node that ends may end for another reason."""
    files = ("a.py", "b.py") if cause == "python-names" else ("CMakeLists.txt", "a.cmake")
    read = [Finding(cause, "It says so.", file, 1, READ, stage="files") for file in files]
    failed = Finding("starts", "It ends.", "a.py", 9, SEEN, stage="run", node="a")
    for finding in (*read, failed):
        finding.severity = "error"
    facts = Facts(sources={"a": ["a.py"]})
    found = causes.without_repeats([*read, failed], facts, {}, has_contract=False)
    weigh(found, has_contract=False)
    assert [finding.severity for finding in read] == [severity, "warning"]


def test_what_was_seen_is_the_cause_before_what_was_only_read():
    read = Finding("messages", "It says so.", "CMakeLists.txt", 1, READ, stage="files")
    seen = Finding("compile", "It stops.", "a.cpp", 3, SEEN, stage="build")
    failed = Finding("starts", "There is no executable.", None, None, SEEN, stage="run", node="a")
    for finding in (read, seen, failed):
        finding.severity = "error"
    facts = Facts(sources={"a": ["a.cpp"]})
    weigh(causes.without_repeats([read, seen, failed], facts, {}, False), has_contract=False)
    assert (failed.consequence_of, read.severity) == ("compile", "warning")


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_rule_sets_no_severity_and_imports_no_rule(path):
    tree = ast.parse(path.read_text())
    names = {alias.name for node in ast.walk(tree) for alias in getattr(node, "names", ())}
    assert not names & {"ERROR", "WARNING", "NOTE"}
    modules = [n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)]
    assert not [module for module in modules if module.startswith("mrp_check.rules")]


def test_each_file_is_a_rule_of_the_tuple():
    assert len(rules.RULES) == len({id(rule) for rule in rules.RULES}) == len(FILES)
