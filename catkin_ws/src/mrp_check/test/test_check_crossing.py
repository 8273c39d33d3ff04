# SPDX-License-Identifier: BSD-3-Clause
"""What crosses from one process to another arrives whole, or is an error that names the place.

A part of what is seen of a node may be missing: no rule of the checker fails because of that.
"""

import check_rules
import pytest
from mrp_check.build import compiler
from mrp_check.code.facts import Facts
from mrp_check.confined import crossing, plans
from mrp_check.confined.places import Kind, Place
from mrp_check.confined.seen import Alone, DirectResult, Event
from mrp_check.run.observing import Observed

pytestmark = pytest.mark.quick

HOOK = plans.Hook("/folder", "/events", "/sources", plans.Wrap("data", 1, 2, 2**32, plans.TOLD))


@pytest.mark.parametrize("value", [HOOK, Place("a.py", 3, Kind.INIT, "node", queue=10)])
def test_what_is_written_is_read(value):
    assert crossing.from_json(type(value), crossing.to_json(value)) == value


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('{"folder"', "{folder", "Expected Hook as JSON; found none: "),
        ('"/folder"', "5", "Hook.folder: expected str; found '5'."),
        ('"step": 2', '"step": true', "Hook.wrap.step: expected int; found 'True'."),
        ('"step"', '"steps"', "Hook.wrap: expected the fields of Wrap; found 'steps'."),
        ('"sources"', '"source"', "Hook: expected the fields of Hook; found 'source'."),
        ('"events": "/events", ', "", "Hook: expected a whole Hook; "),
    ],
)
def test_what_is_not_as_expected_is_an_error_that_names_the_place(old, new, expected):
    text = crossing.to_json(HOOK)
    assert old in text
    with pytest.raises(crossing.CrossingError) as error:
        crossing.from_json(plans.Hook, text.replace(old, new))
    assert expected in str(error.value)


def test_kinds_are_those_that_there_are():
    text = crossing.to_json(Place("a.py", 3, Kind.INIT)).replace("init", "begin")
    with pytest.raises(crossing.CrossingError, match="Place.kind: expected Kind; found 'begin'"):
        crossing.from_json(Place, text)


def test_publisher_whose_topic_nobody_could_tell(tmp_path):
    """rospy.Publisher() without any argument is an error of the node's own: it has no topic."""
    package = check_rules.make(tmp_path / "some_pkg", src__odd_DOT_py="import rospy\n")
    events = [Event("publisher", "src/odd.py", 5), Event("publisher", "src/odd.py", 7, "/great")]
    observed = Observed(direct=DirectResult({"odd": Alone(events=events)}))
    case = check_rules.case_of(package, tmp_path / "scratch", facts=Facts(), observed=observed)
    case.close()
    assert case.places.of_topic("odd", Kind.PUBLISHER, "/group/great") == ("src/odd.py", 7)


def test_compilers_error_that_no_place_of_the_package_leads_to(tmp_path):
    output = "/usr/include/a.h:3:4:   required from 'x'\n/usr/include/a.h:9:9: error: something\n"
    assert compiler.problems(output, tmp_path / "src" / "some_pkg") == []
