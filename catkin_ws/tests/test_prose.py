# SPDX-License-Identifier: BSD-3-Clause
"""What the build of the pages and its tools take for a sentence, for a quote, and for a result.

test_claims.py sees whether the build fails.
"""

import ast

import mutate_prose
import pages
import pytest
import quote_claims
import typed_numbers
from docutils.core import publish_doctree
from docutils.parsers.rst import roles
from mrp_testing import contract
from pages import claims, evidence
from sentences import ProofMark, Sentence, of, of_markdown

pytestmark = pytest.mark.quick


@pytest.fixture
def texts_of(monkeypatch):
    """A function: returns (text, proofs) of each sentence of a text in reStructuredText."""

    def role(name, rawtext, text, lineno, inliner, options=None, content=None):
        return [ProofMark(proof=text)], []

    monkeypatch.setitem(roles._roles, "proof", role)
    return lambda text: [(one.text, one.proofs) for one, _ in of(publish_doctree(text), "page")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("One. Two? *Three*!", [("One.", ()), ("Two?", ()), ("Three!", ())]),
        ("One line\nand **one** more.", [("One line and one more.", ())]),
        ("Paul N. Beuchat, as in 3.5. But", [("Paul N. Beuchat, as in 3.5.", ()), ("But", ())]),
        (
            "A ``b. C`` is a name. No. 5 is.",
            [("A b. C is a name.", ()), ("No.", ()), ("5 is.", ())],
        ),
        ('He says "no." Then.', [('He says "no."', ()), ("Then.", ())]),
        ("One :proof:`a`. Two.", [("One.", ("a",)), ("Two.", ())]),
        ("One. :proof:`a` Two.", [("One.", ("a",)), ("Two.", ())]),
        ("One :proof:`a` :proof:`b`: two\n:proof:`c`.", [("One: two.", ("a", "b", "c"))]),
        ("- One :proof:`a`\n- Two", [("One", ("a",)), ("Two", ())]),
        ("term\n   What it is.", [("term", ()), ("What it is.", ())]),
        (
            ".. image:: a.png\n   :alt: It shows two. No more.",
            [("It shows two.", ()), ("No more.", ())],
        ),
        ("::\n\n   Code. It is.\n\n.. A comment.", []),
    ],
)
def test_sentences(texts_of, text, expected):
    assert texts_of(text) == expected


def test_cell_and_heading_are_sentences(texts_of):
    table = "=====  =====\nOne    Two.\n=====  =====\n"
    assert texts_of(f"Head\n====\n\nText\n\n{table}") == [
        (text, ()) for text in ("Head", "Text", "One", "Two.")
    ]


@pytest.mark.slow  # reads Markdown: MyST comes with what builds the pages
def test_readme_has_its_marks_in_comments(tmp_path):
    path = tmp_path / "README.md"
    path.write_text("# It\n\nIt runs `a. B` <!-- proof: x/y/z -->. See [it](https://a.org).\n")
    found = of_markdown(path)
    assert [(one.text, one.proofs, one.linked, one.page) for one in found] == [
        ("It", (), False, "README"),
        ("It runs a. B.", ("x/y/z",), False, "README"),
        ("See it.", (), True, "README"),
    ]


@pytest.mark.slow  # reads Markdown: MyST comes with what builds the pages
def test_a_test_may_prove_a_whole_table_of_the_readme(tmp_path):
    path = tmp_path / "README.md"
    path.write_text(
        "See [one](two.md):\n\n<!-- proof: x/y/z -->\n\n"
        "| a | b |\n| --- | --- |\n| c | d |\n\nEnd.\n"
    )
    found = of_markdown(path)
    assert [(one.text, one.proofs, one.typed) for one in found] == [
        ("See one:", (), True),
        ("a", ("x/y/z",), False),
        ("b", (), False),
        ("c", (), False),
        ("d", (), False),
        ("End.", (), True),
    ]


@pytest.mark.parametrize(
    ("case", "language"),
    [
        ("test_publisher_py", "Python"),
        ("test_cpp_twin", "C++"),
        ("publisherCpp", "C++"),
        ("test_copy", ""),
        ("test_happy_end", ""),
    ],
)
def test_language_of_a_test_case(tmp_path, case, language):
    path = tmp_path / "test_it.py"
    path.write_text(f"def {case if case.startswith('test') else 'test_' + case}():\n    pass\n")
    (_, test), *_ = evidence.python_cases(path)
    assert test.language == language


def test_last_results_of_rostest_and_pytest(tmp_path):
    (tmp_path / "mrp").mkdir()
    (tmp_path / "mrp" / "rosunit-stop.xml").write_text(
        '<testsuite><testcase name="test_a"/>'
        '<testcase name="test_b"><error/></testcase></testsuite>'
    )
    broken = 'classname="tests.test_broken" name="test_broken_variant_fails'
    (tmp_path / "pytest_slow.xml").write_text(
        f'<testsuites><testsuite><testcase {broken}[e05]"/><testcase {broken}[e06]"><failure/>'
        '</testcase><testcase classname="test_a" name="test_b[1]"/>'
        '<testcase classname="test_a" name="test_b[2]"><skipped/></testcase>'
        "</testsuite></testsuites>"
    )
    (tmp_path / "bookworm").mkdir()
    (tmp_path / "bookworm" / "containers.xml").write_text(
        '<testsuite><testcase classname="docker.test.test_run" name="test_c"/></testsuite>'
    )
    assert evidence.last_results(tmp_path) == {
        "mrp/stop/test_a": True,
        "mrp/stop/test_b": False,
        "broken/e05": True,
        "broken/e06": False,
        "workspace/test_a/test_b": False,
        "docker/test_run/test_c": True,
    }


LONG = "It holds " + "ten and " * 20 + '"one" more.'


def test_quotes_are_written_into_python(tmp_path):
    text = "import os\n\n\nclass Test:\n    @slow\n    def test_it(self):\n        pass\n"
    for quotes in [("One.", LONG), ("Two.",), ()]:
        text = quote_claims.in_python(text, "test_it", quotes)
        path = tmp_path / "test_it.py"
        path.write_text(text)
        assert [test.quotes for _, test in evidence.python_cases(path)] == [quotes]
        assert max(map(len, text.splitlines())) <= 100
        assert text.count("from mrp_testing.proves import proves\n") == 1
        function = ast.parse(text).body[-1].body[0]
        assert len(function.decorator_list) == (2 if quotes else 1)


def test_quotes_are_written_into_cpp(tmp_path):
    text = "int i;\n\n// Why.\nTEST(One, a)\n{\n}\n\nTEST(One, b)\n{\n}\n"
    for quotes in [("One.", LONG), ("Two.",), ()]:
        text = quote_claims.in_cpp(text, "a", quotes)
        path = tmp_path / "test_it.cpp"
        path.write_text(text)
        assert [test.quotes for _, test in evidence.cpp_cases(path)] == [quotes, ()]
        assert "// Why.\n" in text and max(map(len, text.splitlines())) <= 100


def test_quotes_are_written_into_a_defect():
    head = "Breaks: it\nFails: a.test b\nSays: one\n    two\nFinds: x\n\n--- a/b.py\n"
    one = quote_claims.in_patch(head, "it", ("One.", LONG))
    assert one.startswith(
        "Breaks: it\nFails: a.test b\nSays: one\n    two\nProves: One.\nProves: It "
    )
    assert max(map(len, one.splitlines())) <= 100
    assert quote_claims.in_patch(one, "it", ()) == head


def sentence(text, **values):
    return Sentence("pages/one", "one", 1, text, **values)


def test_a_changed_sentence_keeps_its_reason_and_a_new_one_gets_one(tmp_path):
    listed = {"Call make now.": "instruction", "It flies.": "opinion"}
    sentences = [
        sentence("Call make then."),
        sentence("It is proved.", proofs=("a",)),
        sentence("Quite another one?"),
        sentence("See it.", linked=True),
        sentence("Head", heading=True),
        sentence("Claims something new."),
    ]
    wanted = {
        "Head": "heading",
        "Call make then.": "instruction",
        "Quite another one?": "question",
        "See it.": "source",
        "Claims something new.": "open",
    }
    assert quote_claims.wanted_list(sentences, listed) == wanted
    claims.write_list(tmp_path / "one.txt", "pages/one", wanted)
    assert claims.read_list(tmp_path / "one.txt") == wanted


def test_what_is_true_at_its_place_alone_may_not_change_places(tmp_path):
    page = [
        sentence("node", heading=True),
        sentence("A program."),
        sentence("topic", heading=True),
        sentence("A name."),
        sentence("Python", typed=False, placed="Python"),
        sentence("A picture of numbers", typed=False, placed="queue publisher_queue"),
        sentence("made from data", typed=False),
    ]
    digits = [one for _, one in claims.order(page)]
    claims.write_list(tmp_path / "one.txt", "pages/one", {"node": "heading"}, digits)
    assert claims.read_list(tmp_path / "one.txt") == {"node": "heading"}

    def first_moved(sentences, faults=()):
        return [fault.page for fault in claims.moved(sentences, tmp_path, faults)]

    assert first_moved(page) == []
    assert first_moved(page[:-1]) == []
    assert first_moved([page[2], page[1], page[0], *page[3:]]) == ["topic"]
    other_tab = sentence("C++", typed=False, placed="C++")
    assert first_moved([*page[:4], other_tab, *page[5:]]) == ["C++"]
    other_picture = sentence("It", typed=False, placed="queue subscriber_queue")
    assert first_moved([*page[:5], other_picture]) == ["queue subscriber_queue"]
    assert first_moved(page[:3]) == ["topic"]
    # A fault that says more is enough.
    assert first_moved(page[:3], [claims.Fault("not listed", ("pages/one", 1))]) == []


def test_each_page_has_its_order():
    lists = [path for path in pages.LISTS.glob("*.txt") if path.stem not in pages.NOT_CHECKED]
    assert lists and [path.stem for path in lists if not claims.read_order(path)] == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It holds 10 messages.", ["It holds 11 messages."]),
        (
            "In C++ the oldest is first.",
            [
                "In Python the oldest is first.",
                "In C++ the newest is first.",
                "In C++ the oldest is not first.",
                "In C++ the oldest is last.",
            ],
        ),
        ("No value arrives.", ["Each value arrives."]),
        ("Each value in UInt32 of a/first.py.", ["No value in UInt32 of a/first.py."]),
        ("Nothing to change.", ["Nothing not to change."]),
    ],
)
def test_mutants(text, expected):
    assert [mutant.text for mutant in mutate_prose.mutants([sentence(text)])] == expected
    assert mutate_prose.mutants([sentence(text, typed=False)]) == []


def test_score_may_not_fall():
    rows = [{"commit": "a", "percent": "50.0"}, {"commit": "b", "percent": "40.0"}]
    assert mutate_prose.fault(rows, 40.0) is None
    assert mutate_prose.fault([], 1.0) is None
    assert "expected a score of at least 40.0 %, as at b; found 39.9 %" in mutate_prose.fault(
        rows, 39.9
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("It holds 10 messages, or -1.5 of ten.", ("10", "1.5", "ten")),
        ("Twice a day, half of them arrive in two seconds.", ("Twice", "half", "two")),
        ("One of the first, UInt32 in UTF-8, a second time: _ and robot1.", ()),
        ("Debian 12 or 13 has Python 3.11 in terminal 2 since the beginning of 1970.", ()),
        ("Two publishers of the four nodes. It takes 5 minutes.", ()),
        ("Three publishers of the five nodes. It takes 5 hours.", ("Three", "five", "5")),
    ],
)
def test_typed_numbers(text, expected):
    assert typed_numbers.find(text) == expected


def test_nodes_whose_number_may_be_typed_are_those_of_the_contract():
    words = typed_numbers.WORDS
    for number, name in (
        (len(contract.NODES), "nodes"),
        (len(contract.PUBLISHERS), "publishers"),
        (len(contract.SUBSCRIBERS), "subscribers"),
    ):
        assert [word for word in words[2:] if not typed_numbers.find(f"{word} {name}")] == [
            words[number]
        ]


def test_a_number_is_typed_in_prose_alone(texts_of):
    document = publish_doctree("It holds ``10`` of 20 messages.")
    assert [one.numbers for one, _ in of(document, "page")] == [("20",)]


@pytest.mark.slow  # the extension needs Sphinx
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
        ("times.rows[0].size", "8"),
    ],
)
def test_value_is_taken_from_where_it_is_defined(tmp_path, expression, expected):
    import value

    assert value.value_of(expression, sources(tmp_path)) == expected


@pytest.mark.slow  # the extension needs Sphinx
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("contract.QUEUE", "such as QUEUE_SIZE; found QUEUE"),
        ("contrac.QUEUE_SIZE", "such as contract; found contrac"),
        ("one.talker.perod", "such as period; found perod"),
        ("one.listner", "such as listener; found listner"),
        ("one.talker", "expected a number or a text, found"),
        ("1 +", "expected an expression, found '1 \\+'"),
    ],
)
def test_an_unknown_value_is_an_error_with_the_nearest_names(tmp_path, expression, expected):
    import value

    with pytest.raises(value.UnknownError, match=expected):
        value.value_of(expression, sources(tmp_path))


def sources(folder):
    """Return value.Sources of a folder with a launch file and a recording."""
    import value

    launch = folder / "mrp_labs" / "launch" / "one.launch"
    recording = folder / "mrp" / "doc" / "recorded" / "times.json"
    for path in (launch, recording):
        path.parent.mkdir(parents=True)
    launch.write_text(
        '<launch><arg name="queue_size" default="4"/><group ns="a">'
        '<param name="~queue_size" value="$(arg queue_size)"/>'
        '<node name="talker"><param name="period" value="0.5"/>'
        '<param name="latch" value="true"/></node></group><node name="listener"/></launch>'
    )
    recording.write_text('{"rows": [{"size": 8}]}')
    return value.Sources(folder)


@pytest.mark.slow  # the extension needs Sphinx
def test_a_picture_says_in_words_what_it_draws():
    import picture

    of = object.__new__
    graph = {
        "topics": {"/a": "std_msgs/UInt32", "/b": "std_msgs/String"},
        "publishers": [["/one", "/a"], ["/two", "/a"]],
        "subscribers": [["/two", "/b"]],
    }
    assert of(picture.Graph).alt(graph) == (
        "Topic /a, type std_msgs/UInt32: published by /one, /two; subscribed to by no node. "
        "Topic /b, type std_msgs/String: published by no node; subscribed to by /two."
    )
    assert of(picture.Queue).alt(9, {"one": {1, 2, 3, 9}, "two": {4}}) == (
        "Messages 1 to 9. one received 1 to 3, 9. two received 4."
    )
    events = [{"node": "/one", "what": "published", "value": value} for value in "21"]
    assert of(picture.Timeline).alt(events) == "/one published 2, 1."
