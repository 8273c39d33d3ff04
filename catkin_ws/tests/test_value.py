# SPDX-License-Identifier: BSD-3-Clause
"""The role `value`, which takes what a page says from where it is defined; a picture in words."""

import sys

import pytest
from mrp_testing.workspace import WORKSPACE

sys.path.insert(0, str(WORKSPACE / "src" / "mrp" / "doc" / "extension"))

# The extension needs Sphinx, which `make test` does not install: so each test imports it.
pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("contract.QUEUE_SIZE + 1", "11"),
        ("contract.TOPIC", "great_topic"),
        ("one.talker.period", "0.5"),
        ("one.talker.queue_size", "4"),
        ("one.queue_size", "4"),
        ("one.talker.latch", "true"),
        ("word(len(one.nodes))", "two"),
        ("rosmaster.DEFAULT_MASTER_PORT", "11311"),
    ],
)
def test_value_is_taken_from_where_it_is_defined(tmp_path, expression, expected):
    import value

    assert value.value_of(expression, sources(tmp_path)) == expected


@pytest.mark.parametrize(
    "expression", ["contract.QUEUE", "contrac.QUEUE_SIZE", "one.talker", "1 +"]
)
def test_what_has_no_value_is_an_error(tmp_path, expression):
    import value

    with pytest.raises((AttributeError, NameError, TypeError, SyntaxError)):
        value.value_of(expression, sources(tmp_path))


def sources(folder):
    """Return value.Sources of a folder with a launch file."""
    import value

    launch = folder / "mrp_labs" / "launch" / "one.launch"
    launch.parent.mkdir(parents=True)
    launch.write_text(
        '<launch><arg name="queue_size" default="4"/><group ns="a">'
        '<param name="~queue_size" value="$(arg queue_size)"/>'
        '<node name="talker"><param name="period" value="0.5"/>'
        '<param name="latch" value="true"/></node></group><node name="listener"/></launch>'
    )
    return value.Sources(folder)


def test_a_picture_says_in_words_what_it_draws():
    import picture

    of = object.__new__
    graph = {
        "topics": {"/a": "std_msgs/UInt32", "/b": "std_msgs/String", "/c": "std_msgs/String"},
        "publishers": ["/one -> /a", "/two -> /a"],
        # A node may have the name of its topic, as /rosout does.
        "subscribers": ["/b -> /two", "/c -> /c"],
    }
    assert of(picture.Graph).alt(graph) == (
        "Topic /a, type std_msgs/UInt32: published by /one, /two; subscribed to by no node. "
        "Topic /b, type std_msgs/String: published by no node; subscribed to by /two. "
        "Topic /c, type std_msgs/String: published by no node; subscribed to by /c."
    )
    assert of(picture.Queue).alt(9, {"one": {1, 2, 3, 9}, "two": {4}}) == (
        "Messages 1 to 9. one received 1 to 3, 9. two received 4."
    )
