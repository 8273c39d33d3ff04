# SPDX-License-Identifier: BSD-3-Clause
"""One cause is reported once: what follows from it is its consequence, and nothing else is."""

import pytest
from mrp_check.code.facts import Facts
from mrp_check.contract.finding import Finding
from mrp_check.run import words
from mrp_check.verdict import causes

pytestmark = pytest.mark.quick


MISSING = "dependencies package.xml:9 files -"
FAILED = "compile src/a.cpp:1 build -"


def facts():
    found = Facts()
    found.sources = {"a": ["src/a.py"], "b": ["src/b.py"]}
    return found


def findings(*entries):
    """Return an error for each entry, such as "spin src/a.py:1 static a"; "-" stands for none."""
    found = []
    for entry in entries:
        id_, place, stage, node = (None if word == "-" else word for word in entry.split())
        file, _, line = (place or "").partition(":")
        found.append(Finding(id_, "It is so.", file or None, int(line) if line else None))
        found[-1].stage, found[-1].node, found[-1].severity = stage, node, "error"
    return found


# What is found -> of what each but the first is a consequence.
@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        # What one node does wrong, it does wrong when it runs; another is sent values all the same.
        (["spin src/a.py:1 static a", "starts src/a.py:1 run a"], ["spin"]),
        (["python-syntax src/a.py:1 static -", "values src/a.py:5 run a"], ["python-syntax"]),
        (["python-syntax src/a.py:1 static -", "received src/b.py:5 run b"], [None]),
        (["python-names src/a.py:5 static -", "spin src/a.py:5 static a"], ["python-names"]),
        # Another node's own fault is its own.
        (["spin src/a.py:1 static a", "exit src/b.py:5 stop b"], [None]),
        (["queue src/a.py:1 static a", "values src/a.py:5 run a"], [None]),
        # What was seen of a program that ran does not follow from what may hinder its building.
        (["messages CMakeLists.txt:1 files -", "exit a:5 stop b"], [None]),
        # What keeps all from being built.
        (["configure CMakeLists.txt:1 build -", "starts - run b"], ["configure"]),
        (["targets CMakeLists.txt:4 files -", "configure CMakeLists.txt:4 build -"], ["targets"]),
        # Of two possible causes, the one that stands where CMake stops.
        (
            [MISSING, "cmake CMakeLists.txt:4 files -", "configure CMakeLists.txt:4 build -"],
            [None, "cmake"],
        ),
        (
            [
                MISSING,
                "package-name CMakeLists.txt:2 files -",
                "configure CMakeLists.txt:4 build -",
            ],
            [None, "package-name"],
        ),
        # Two faults of the same kind in two sources are two.
        (["compile src/a.cpp:4 build -", "compile src/b.cpp:4 build -"], [None]),
        # Without the launch file, the checker starts the nodes by its own.
        (["launch-file - files -", "rate src/a.py:5 run a"], [None]),
        # A script that is no node of the exercise keeps no node from anything.
        (["python-names src/c.py:5 static -", "rate src/a.py:5 run a"], [None]),
        # A second instance of a defect is another defect.
        (["wrap src/a.py:5 static a", "wrap src/a.py:9 static a"], [None]),
        (["targets CMakeLists.txt:4 static a", "launch-nodes a.launch:9 static b"], [None]),
    ],
    ids=range(16),
)
def test_consequences(entries, expected):
    reported = causes.without_repeats(findings(*entries), facts())
    assert [finding.consequence_of for finding in reported] == [None, *expected]


class Ran:
    """What was seen of a node that runs."""

    is_up = True

    def has_rate(self):
        return True


@pytest.mark.parametrize(
    "cause", ["configure CMakeLists.txt:1 build -", "python-names src/a.py:5 static -"]
)
def test_what_was_seen_all_the_same_is_no_consequence(cause):
    entries = cause, "rate src/a.py:5 run a"
    assert causes.without_repeats(findings(*entries), facts())[1].consequence_of in cause
    seen = causes.without_repeats(findings(*entries), facts(), {"a": Ran()})
    assert seen[1].consequence_of is None


@pytest.mark.parametrize(
    ("missing", "cause"),
    [(("std_srvs",), "dependencies"), (("some_pkg",), None), ((), None)],
    ids=range(3),
)
def test_a_missing_header_follows_from_its_own_package(missing, cause):
    undeclared, failed = findings(MISSING, FAILED)
    undeclared.packages, failed.packages = ("std_srvs",), missing
    causes.without_repeats([undeclared, failed])
    assert failed.consequence_of == cause


@pytest.mark.parametrize(
    ("missing", "file", "cause"),
    [
        (("some_pkg",), "CMakeLists.txt", "messages"),
        ((), "CMakeLists.txt", None),
        ((), "msg/Num.msg", "messages"),
    ],
    ids=range(3),
)
def test_what_stands_behind_a_header_that_is_not_made_stands_for_itself(missing, file, cause):
    unmade, failed = findings(f"messages {file}:9 files -", FAILED)
    failed.packages = missing
    causes.without_repeats([unmade, failed])
    assert failed.consequence_of == cause


def test_what_one_line_lacks_is_told_of_each():
    first, second = findings(MISSING, MISSING)
    first.expected, second.expected = "<depend>std_msgs</depend>", "<depend>std_srvs</depend>"
    assert causes.without_repeats([first, second]) == [first, second]


def test_the_same_is_told_once():
    for other, count in (("a", 1), ("-", 1), ("b", 2)):
        entries = f"spin src/a.py:1 static {other}", "spin src/a.py:1 static a"
        assert len(causes.without_repeats(findings(*entries), facts())) == count


def test_last_words_have_no_time():
    """They are the same in each run."""
    lines = ["[ INFO] [1795624487.418407537]: yes", "[ERROR] [1795624487.5, 3.2]: no", ""]
    assert words.last_words(lines) == "ERROR: no"
    broken = ["[FATAL] [1.5]: BREAKPOINT HIT", "\tfile = node_handle.cpp", "\tline=157"]
    assert words.last_words([*lines, *broken]) == "ERROR: no"


def test_a_node_may_end_before_it_gets_to_an_undefined_name():
    entries = "python-names src/a.py:5 static -", "starts src/a.py:9 run a"
    _, end = causes.without_repeats(findings(*entries), facts(), has_contract=False)
    assert end.consequence_of is None
