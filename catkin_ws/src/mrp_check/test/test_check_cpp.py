# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about C++ sources, as clang reads them; nothing is built."""

import re
import shutil
import subprocess

import check_rules
import pytest
from check_rules import said_by_clang, told
from mrp_check.code import facts as facts_
from mrp_check.code import reading
from mrp_check.confined import cpp_headers
from mrp_check.confined.places import Kind
from mrp_testing.workspace import WORKSPACE

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("check_cpp")]

FOLDER = WORKSPACE / "src" / "mrp" / "src"
PUBLISHER, SUBSCRIBER = "publisher_cpp_node", "subscriber_cpp_node"
SOURCES = {name: (FOLDER / f"{name}.cpp").read_text() for name in (PUBLISHER, SUBSCRIBER)}


@pytest.fixture(scope="session")
def headers(tmp_path_factory):
    return cpp_headers.make(tmp_path_factory.mktemp("headers") / cpp_headers.NAME)


def findings(folder, headers, node, source):
    """Return what the rules say of a node of the tutorial that is made of a source."""
    package = check_rules.make(folder, src__a_DOT_cpp=source)
    result = said_by_clang(folder, headers)
    assert result.errors == []
    facts = facts_.Facts()
    reading.mark_unused(facts, reading.take(facts, "src/a.cpp", result))
    facts.sources[node] = ["src/a.cpp"]
    model = check_rules.model_of(package)
    return check_rules.node_findings(package, model, facts)


def replaced(node, *changes):
    source = SOURCES[node]
    for old, new in changes:
        assert source.count(old) == 1, old
        source = source.replace(old, new)
    return source


TIMER = "timer_ = nh_.createTimer(ros::Duration(0.5), &PublisherCppNode::timerCallback, this);"
ADVERTISE = 'publisher_ = nh_.advertise<std_msgs::UInt32>("great_topic", 10);'
SUBSCRIBE = "subscriber_ = nh_.subscribe"

COUNT = "counter_ += 2;"

# The node, what is replaced, and the finding: its id, the text of its line, and a word of it.
BROKEN = {
    "no_spin_no_return": (
        PUBLISHER,
        [("  ros::spin();\n", ""), ("  return 0;\n", "")],
        "spin",
        "}",
        "end of main",
    ),
    "spin_once": (SUBSCRIBER, [("ros::spin()", "ros::spinOnce()")], "spin", "spinOnce", "at once"),
    "discarded": (
        SUBSCRIBER,
        [(SUBSCRIBE, "nh_.subscribe")],
        "lifetime",
        "subscribe",
        "kept anywhere",
    ),
    "local_publisher": (
        PUBLISHER,
        [
            (f"    {ADVERTISE}\n", ""),
            (
                "publisher_.publish",
                ADVERTISE.replace("publisher_ =", "auto own =") + " own.publish",
            ),
        ],
        "lifetime",
        "auto own",
        "destroyed when that function returns",
    ),
    "no_timer": (PUBLISHER, [(TIMER, "")], "callbacks", "void timerCallback", "nothing ever"),
    "signed_counter": (
        PUBLISHER,
        [("uint32_t counter_", "int counter_")],
        "wrap",
        "int counter_",
        "undefined",
    ),
    "float_counter": (
        PUBLISHER,
        [("uint32_t counter_", "float counter_")],
        "wrap",
        "float counter_",
        "whole steps",
    ),
}


@pytest.mark.parametrize(("node", "changes", "id_", "line", "words"), BROKEN.values(), ids=BROKEN)
def test_broken_line_is_found(node, changes, id_, line, words, tmp_path, headers):
    source = replaced(node, *changes)
    found = findings(tmp_path, headers, node, source)
    assert [finding.id for finding in found] == [id_], found
    assert line in source.splitlines()[found[0].line - 1]
    assert re.search(words, f"{found[0].message} {found[0].expected}")


TEMPLATE = """template <typename T>
std::uint32_t take(const T& from)
{
  std::uint32_t taken = 0;
  taken = from.data;
  return taken;
}
"""
# What no package of correct/ has.
CORRECT = {
    # It is wrong, but no line says so: what it publishes does.
    "skips": (PUBLISHER, [(COUNT, "counter_ += counter_ == 8 ? 4 : 2;")]),
    "template": (PUBLISHER, [("class Pub", TEMPLATE + "\nclass Pub")]),
    "publish_on_either": (
        PUBLISHER,
        [
            (
                ADVERTISE,
                ADVERTISE.replace("publisher_ =", "ros::Publisher own =")
                + " (own ? own : publisher_).publish(std_msgs::UInt32()); publisher_ = own;",
            )
        ],
    ),
    "long_counter": (PUBLISHER, [("uint32_t counter_", "uint64_t counter_")]),
}


@pytest.mark.parametrize(("node", "changes"), CORRECT.values(), ids=CORRECT)
def test_what_is_correct_is_not_flagged(node, changes, tmp_path, headers):
    assert told(findings(tmp_path, headers, node, replaced(node, *changes))) == []


def test_a_source_may_be_in_any_encoding(tmp_path, headers):
    text = SOURCES[PUBLISHER].replace("namespace of node", "\xd7\xd4 namespace of node")
    check_rules.make(tmp_path, src__a_DOT_cpp=text.encode("latin-1"))
    places = said_by_clang(tmp_path, headers).places
    assert [place.text for place in places if place.kind is Kind.PUBLISHER] == ["great_topic"]


def test_headers_that_do_not_fit_are_read_again(tmp_path, headers):
    check_rules.make(tmp_path, src__a_DOT_cpp=SOURCES[PUBLISHER])
    result = said_by_clang(tmp_path, headers)
    assert {place.kind for place in result.places} >= {Kind.PUBLISHER, Kind.LOG, Kind.STEP}
    assert said_by_clang(tmp_path, headers, ("-std=gnu++20",)) == result
    assert said_by_clang(tmp_path, tmp_path / "no_such_file") == result


def test_headers_are_kept_until_others_are_installed(tmp_path, headers, monkeypatch):
    cache, made = tmp_path / "cache", []

    def read(command, **_):
        made.append(command[-1])
        shutil.copy(headers, command[-1])

    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    monkeypatch.setattr(subprocess, "run", read)
    first, second, third = (tmp_path / name for name in ("first", "second", "third"))
    for path in (first, second):
        assert cpp_headers.make(path).read_bytes() == headers.read_bytes()
    assert made == [str(first)]
    installed = tmp_path / "status"
    installed.touch()
    monkeypatch.setattr(cpp_headers, "_INSTALLED", (str(installed),))
    assert cpp_headers.make(third).exists()
    assert made == [str(first), str(third)]
    (only,) = (cache / "mrp_check").iterdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(installed))  # a file: nothing can be kept there
    only.unlink()
    assert cpp_headers.make(tmp_path / "fourth").exists()
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert cpp_headers.make(tmp_path / "fifth").exists()
    assert not (tmp_path / "home").exists()
