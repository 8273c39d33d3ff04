# SPDX-License-Identifier: BSD-3-Clause
"""The styles, which packages.py lays out: each makes a package, and a fault in one is a sentence.

test_check_sets.py builds and runs them.
"""

import xml.etree.ElementTree as ElementTree

import check_sets
import pytest
from mrp_check.contract import resources, spec
from mrp_check.rules import REQUIREMENTS

pytestmark = pytest.mark.quick

OTHERS = check_sets.STYLES[1:]  # than the tutorial's

FIELDS = ("Base", "Without", "CRLF", "Spec", "Warns")


@pytest.mark.parametrize("style", OTHERS)
def test_style_makes_a_package(style, tmp_path):
    check_sets.lay_out(style, tmp_path)
    contract = spec.read(resources.folder("contracts") / check_sets.spec_of(style))
    expected = {"package", "launch"} if contract.launch.file else {"package"}
    xml = [path for path in tmp_path.rglob("*") if path.suffix in (".launch", ".xml")]
    assert {ElementTree.parse(path).getroot().tag for path in xml} == expected


@pytest.mark.parametrize("style", OTHERS)
def test_head_names_what_is_there(style):
    fields = check_sets.fields_of(style)
    assert {*fields} <= {"SPDX-License-Identifier", "Style", *FIELDS}
    assert fields["Base"][0] in (*check_sets.STYLES, "nothing")
    assert (resources.folder("contracts") / check_sets.spec_of(style)).exists()
    assert [id_ for id_ in fields.get("Warns", []) if id_ not in REQUIREMENTS] == []
