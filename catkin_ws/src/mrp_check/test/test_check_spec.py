# SPDX-License-Identifier: BSD-3-Clause
"""Reads specs: ours are right, and for a wrong one the error names file, line and key."""

import json
import re

import pytest
from mrp_check import rules
from mrp_check.contract import resources, spec
from mrp_check.contract.errors import SpecError
from mrp_check.contract.requirements import STAGES
from mrp_check.rules import REQUIREMENTS

pytestmark = pytest.mark.quick

MINIMAL = """title: An exercise
topics:
  a_topic:
    type: std_msgs/UInt32
nodes:
  a_node:
    publishes:
      topic: a_topic
launch:
  file: a.launch
"""


def test_our_specs_can_be_read():
    names = {path.stem for path in spec.find("pub_sub").parent.iterdir()}
    wiki = {"talker_listener_cpp", "talker_listener_py"}
    others = {"add_two_ints", "filter", "turtle"}
    assert names == {"pub_sub", "relay", "replay", "parameter"} | others | wiki
    for name in names:
        contract = spec.read(spec.find(name))
        assert contract.nodes and bool(contract.topics) != bool(contract.services)
        has_launch = name not in others | wiki
        assert bool(contract.launch.file) == contract.asks("launch-file") == has_launch


def test_each_key_says_what_it_is():
    """The page is made of it."""
    schema = json.loads(spec.SCHEMA.read_text())
    definitions = schema.pop("definitions")
    for entry in (schema, *definitions.values()):
        for key, value in entry.get("properties", {}).items():
            referred = definitions[value["$ref"].split("/")[-1]] if "$ref" in value else {}
            assert value.get("description") or referred.get("description"), key


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("title: An exercise\n", "", r":1: .*expected the key 'title'; it is missing\."),
        ("topic: a_topic", "topic: a_topik", r":8: .*no topic 'a_topik'.*mean 'a_topic'\?"),
        ("publishes:", "publish:", r":6: .*no key 'publish'.*mean 'publishes'\?"),
        ("std_msgs/UInt32", "UInt32", r":4: topics\.a_topic\.type: expected a type such as"),
        ("std_msgs/UInt32", "3", r":4: .*expected a text; found 3\."),
        ("topic: a_topic", "topic: a_topic\n      queue: 0", r":9: .*at least 1; found 0\."),
        ("topic: a_topic", "topic: a_topic\n    prints: ['[A']", r":9: .*isn't a regular expr"),
        ("topic: a_topic", "topic: a_topic\n    prints: ['{valeu}']", r":9: .*mean 'value'\?"),
        ("topic: a_topic", "topic: a_topic\n    prints: ['[AB] 1']", r":9: .*one letter of 'AB'"),
        ("std_msgs/UInt32", "PACKAGE/Count", r":4: .*'messages' has no message 'Count'"),
        ("launch:", "points: {valuse: 1}\nlaunch:", r":9: .*no requirement 'valuse'.*'values'\?"),
        ("launch:", "hidden:\n- wrap\n- valus\nlaunch:", r":11: hidden\.1: .*mean 'values'\?"),
        ("launch:", "hidden: values\nlaunch:", r":9: hidden: expected a list; found 'values'"),
        ("launch:", "topics: {}\nlaunch:", r":9: .*the key 'topics' appears twice"),
        ("title: An", "title: [An", r":\d+: .*isn't valid YAML"),
        ("    type: std", "\ttype: std", r":4: .*isn't valid YAML"),
        ("std_msgs/UInt32", "std_msgs/UInt23", r":4: .*no message 'std_msgs/UInt23'.*mean"),
        ("std_msgs/UInt32", "no_msgs/UInt32", r":4: .*no message 'no_msgs/UInt32'"),
        (
            "UInt32",
            "UInt32\n    field: dta",
            r":5: .*'dta'; std_msgs/UInt32 has: data\. Did you mean",
        ),
        ("UInt32", "Header\n    field: stamp.secs.x", r":5: .*time has no fields"),
        ("UInt32", "Header\n    field: data", r":5: .*seq, stamp, frame_id"),
        (
            "launch:",
            "messages: {A: {b: uint23}}\nlaunch:",
            r":9: messages\.A\.b: .*message 'uint23'",
        ),
        ("std_msgs/UInt32", "std_msgs/UInt32\n    text: a {value}", r":5: .*is a uint32\."),
        ("std_msgs/UInt32", "std_msgs/String\n    text: hello", r":5: .*text with \{value\} in it"),
        ("launch:", "not_asked: [quue]\nlaunch:", r":9: not_asked\.0: .*mean 'queue'\?"),
    ],
    ids=range(25),
)
def test_wrong_spec_is_told_in_one_sentence(old, new, says, tmp_path):
    path = tmp_path / "wrong.yaml"
    assert MINIMAL.count(old) == 1
    path.write_text(MINIMAL.replace(old, new))
    with pytest.raises(SpecError) as error:
        spec.read(path, REQUIREMENTS)
    assert str(error.value).startswith(str(path))
    assert re.search(says, str(error.value)), error.value
    assert "\n" not in str(error.value)
    if "YAML" not in str(error.value):
        assert str(error.value).endswith(str(spec.SCHEMA))


SERVICE = """title: An exercise
topics:
  a_topic: {type: std_msgs/Float64}
services:
  a_service:
    type: PACKAGE/Add
    request: {a: int64}
    response: {sum: int64, text: string}
    examples:
    - {request: {a: 2}, response: {sum: 4, text: 'a {any}'}}
nodes:
  a_node:
    offers: a_service
    publishes: {topic: a_topic}
    examples:
    - parameters: {step: 2}
      receives: {a_topic: {data: 1}}
      publishes: {a_topic: {data: 2}}
"""


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("{a: 2}", "{b: 2}", r":10: services\.a_service\.examples\.0\.request\.b: .* has: a\."),
        ("sum: 4", "sum: four", r":10: .*response\.sum: expected a number.*int64; found 'four'"),
        ("'a {any}'", "4", r":10: .*expected a text.*found 4\."),
        ("PACKAGE/Add", "std_srvs/SetBol", r":6: .*no service .*|:7: .*only a type of PACKAGE"),
        ("a: int64", "a: int46", r":7: services\.a_service\.request\.a: .*no message 'int46'"),
        (
            "offers: a_service",
            "offers: a_servise",
            r":13: nodes\.a_node\.offers: .*mean 'a_service'",
        ),
        ("receives: {a_topic", "receives: {b_topic", r":17: .*no topic 'b_topic'"),
        ("publishes: {a_topic: {data", "publishes: {a_topic: {dat", r":18: .*mean 'data'"),
        ("step: 2", "step: [2]", r":16: .*parameters\.step: expected a number, a text, true or"),
        (
            "      publishes: {a_topic: {data: 2}}\n",
            "",
            r":16: .*the key 'publishes'; it is missing",
        ),
    ],
    ids=range(10),
)
def test_wrong_example_is_told_in_one_sentence(old, new, says, tmp_path):
    path = tmp_path / "wrong.yaml"
    path.write_text(SERVICE)
    (example,) = spec.read(path).nodes["a_node"].examples
    assert example.publishes == {"a_topic": ({"data": 2},)}
    assert SERVICE.count(old) == 1
    path.write_text(SERVICE.replace(old, new))
    with pytest.raises(SpecError, match=says):
        spec.read(path, REQUIREMENTS)


@pytest.mark.parametrize("key", ["values: {start: 1, step: 1}", "rises: true"])
def test_only_numbers_count(key, tmp_path):
    path = tmp_path / "wrong.yaml"
    text = MINIMAL.replace("UInt32", "String") + "\n"
    path.write_text(text.replace("topic: a_topic", f"topic: a_topic\n      {key}"))
    with pytest.raises(
        SpecError, match=r":9: nodes\.a_node\.publishes\.\w+: data of .* not a number"
    ):
        spec.read(path)


def test_requirements_point_to_pages_that_exist():
    pages = resources.folder("contracts").parents[1] / "mrp" / "doc" / "pages"
    assert {requirement.stage for requirement in REQUIREMENTS.values()} == set(STAGES)
    for requirement in REQUIREMENTS.values():
        page, _, anchor = requirement.section.partition("#")
        lines = (pages / f"{page}.rst").read_text().splitlines()
        titles = [line for line, below in zip(lines, lines[1:]) if re.fullmatch(r"[-=]{3,}", below)]
        anchors = [re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") for title in titles]
        assert not anchor or anchor in anchors, (requirement.section, anchors)


def test_what_a_rule_can_report_is_some_rule_s_own():
    """A requirement stands in one rule alone; others may find it not met."""
    own = [id_ for rule in rules.RULES for id_ in rule.requirements]
    assert sorted(own) == sorted(REQUIREMENTS)
    assert {id_ for rule in rules.RULES for id_ in rule.also} <= {*own}
