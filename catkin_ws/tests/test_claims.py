# SPDX-License-Identifier: BSD-3-Clause
"""A sentence, its proof and its list cannot change alone: the build fails, and says why.

The pages here are small ones, in a small workspace of their own with the real extension.
"""

import pathlib
import shutil
import subprocess
import sys

import mutate_prose
import pytest
from mrp_testing.proves import proves

pytestmark = pytest.mark.slow

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
DOC = "catkin_ws/src/mrp/doc"
PAGE = f"{DOC}/pages/one.rst"
LIST = f"{DOC}/unproved/one.txt"
PYTHON = "catkin_ws/src/mrp/test/test_one.py"
CPP = "catkin_ws/src/mrp/test/test_one.cpp"
PATCH = "catkin_ws/defects/one.patch"
DOCKER = "docker/test/test_run.py"
LAUNCH = "catkin_ws/src/mrp/launch/one.launch"
UNTYPED = f"{DOC}/untyped.txt"
OUTPUTS = f"{DOC}/recorded/outputs.json"

FILES = {
    f"{DOC}/conf.py": """\
import pathlib, sys
sys.path.insert(0, str(pathlib.Path(__file__).parent / "extension"))
extensions = ["sphinx_inline_tabs", "proof", "listing", "value", "terminal", "commands"]
pages_not_checked_yet = ["index", "pages/tests"]
""",
    f"{DOC}/index.rst": """\
Start
=====

.. toctree::

   pages/one
   pages/tests
""",
    f"{DOC}/pages/tests.rst": """\
The tests
=========

.. tests::
""",
    PAGE: """\
One
===

A queue of ``1.5`` drops
the *oldest* value :proof:`mrp/one/test_both`. Paul N. Beuchat is
named. Is it so :proof:`docker/test_run/test_it`?
It waits for :value:`one.waiter.seconds` s :proof:`docker/test_run/test_it`.

.. tab:: Python

   It "never" blocks :proof:`mrp/one/test_publisher_py`.

.. tab:: C++

   It blocks :proof:`mrp/one/publisherCpp` :proof:`broken/one`: at once.

See `the API <https://example.org/api>`_.

.. terminal:: 1
   :output: it
   :shows: ^data: 1$ ... ^data: 2$

   rostopic echo /it

.. code-block:: bash

   sudo make install
""",
    UNTYPED: "[needs root]\nsudo make install\n",
    OUTPUTS: '{"it": ["data: 1", "data: 2"]}',
    LIST: """\
# A comment.

[heading]
One

[definition]
Paul N. Beuchat is named.

[source]
See the API.
""",
    PYTHON: '''\
class TestOne:
    @proves(
        "A queue of 1.5 drops "
        "the oldest value."
    )
    def test_both(self):
        """What it does."""

    @proves('It "never" blocks.')
    def test_publisher_py(self):
        pass
''',
    CPP: """\
// What the class does.
// Proves: It blocks:
//   at once.
TEST(One, publisherCpp)
{
}
""",
    PATCH: """\
Breaks: it
Fails: one.test test_both
Says: it
Proves: It blocks: at
    once.

--- a/src/one.cpp
+++ b/src/one.cpp
""",
    LAUNCH: '<launch><node name="waiter"><param name="seconds" value="7"/></node></launch>',
    DOCKER: """\
@proves("Is it so?", "It waits for 7 s.")
def test_it():
    pass
""",
}


@pytest.fixture
def root(tmp_path):
    """The folder of a small repository, whose pages build."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / PYTHON).chmod(0o755)  # a program, which rostest runs
    ignore = shutil.ignore_patterns("__pycache__")
    for folder in ("mrp/doc/extension", "mrp_check/src/mrp_check/contract"):
        source = WORKSPACE / "src" / folder
        shutil.copytree(source, tmp_path / "catkin_ws" / "src" / folder, ignore=ignore)
    # With it the copy wins over the package of a sourced workspace.
    (tmp_path / "catkin_ws/src/mrp_check/src/mrp_check/__init__.py").touch()
    return tmp_path


def build(root):
    """Build the pages; return the exit code and what was said."""
    options = ("-q", "-W", "--keep-going", "-d", root / "doctrees")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, root / DOC, root / "site"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    return done.returncode, done.stdout


def change(root, file, old, new):
    path = root / file
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))


@proves("A small link at the end of a sentence leads to the test that proves it.")
def test_what_fits_together_is_built(root):
    code, said = build(root)
    assert code == 0, said
    assert "Sentences: 5 proved, 1 heading, 0 instruction, 1 definition, " in said
    page = (root / "site/pages/one.html").read_text()
    label = "Proof by the test test_both: A queue of 1.5 drops the oldest value."
    assert f'href="tests.html#mrp-one-test-both" aria-label="{label}">' in page
    assert "Proof by the test test_publisher_py: It &quot;never&quot; blocks." in page


CHANGES = {
    "a claim": (
        PAGE,
        ("*oldest*", "*newest*"),
        [
            "one.rst:4: WARNING: The test mrp/one/test_both does not quote this sentence.",
            "page: A queue of 1.5 drops the newest value.",
            "test: A queue of 1.5 drops the oldest value.",
            "file: catkin_ws/src/mrp/test/test_one.py, line 6",
        ],
    ),
    "a name in code": (PAGE, ("1.5", "2.5"), ["page: A queue of 2.5 drops the oldest value."]),
    "a quote in Python": (
        PYTHON,
        ("oldest", "newest"),
        ["page: A queue of 1.5 drops the oldest", "test: A queue of 1.5 drops the newest value."],
    ),
    "a quote in C++": (
        CPP,
        ("at once", "later"),
        ["The test mrp/one/publisherCpp does not quote", "test: It blocks: later."],
    ),
    "a quote in a defect": (
        PATCH,
        ("once", "last"),
        ["The test broken/one does not quote", "test: It blocks: at last."],
    ),
    "a quote in a container's test": (
        DOCKER,
        ("so", "thus"),
        ["The test docker/test_run/test_it does not quote", "test: Is it thus?"],
    ),
    "a quote too many": (
        DOCKER,
        ('"Is it so?"', '"Is it so?", "Pigs fly."'),
        [
            "docker/test/test_run.py:2: WARNING: The test docker/test_run/test_it quotes a",
            "Pigs fly.",
        ],
    ),
    "a quote that is computed": (
        DOCKER,
        ('"Is it so?"', 'f"Is it so?"'),
        ["test_run.py, line 1: expected a text in quotes in @proves"],
    ),
    "no proof": (
        PAGE,
        (" :proof:`mrp/one/test_both`", ""),
        ["No test proves this sentence", "page: A queue of 1.5 drops the oldest value."],
    ),
    "a proof that does not exist": (
        PAGE,
        ("test_both", "test_none"),
        ["There is no test mrp/one/test_none: correct the mark."],
    ),
    "the other language's proof": (
        PAGE,
        (":proof:`mrp/one/test_publisher_py`", ":proof:`mrp/one/publisherCpp`"),
        ["stands in the tab of one language, and mrp/one/publisherCpp is of the other one"],
    ),
    "a sentence of the list": (
        PAGE,
        ("Paul N. Beuchat is", "Paul N. Beuchat is not"),
        [
            "the list of its page does not have it",
            "page: Paul N. Beuchat is not named.",
            "list: Paul N. Beuchat is named.",
        ],
    ),
    "a heading": (PAGE, ("One\n", "Two\n"), ["page: Two", "list: One"]),
    "a sentence less": (
        PAGE,
        ("Paul N. Beuchat is\nnamed. ", ""),
        ["unproved/one.txt:1: WARNING: The list of unproved", "list: Paul N. Beuchat is named."],
    ),
    "a link": (
        PAGE,
        ("`the API <https://example.org/api>`_", "the API"),
        ["The list says that this sentence is taken from a source."],
    ),
    "a reason": (
        LIST,
        ("[definition]", "[because]"),
        ["gives an unknown reason. Expected one of: heading, "],
    ),
    "a command in a block": (
        PAGE,
        ("sudo make install", "sudo make isntall"),
        [
            "one.rst:25: WARNING: no reader types the command 'sudo make isntall'",
            "untyped.txt:1: WARNING: no page has the command 'sudo make install'",
        ],
    ),
    "a command in a sentence": (
        PAGE,
        ("``1.5``", "``rostopic ehco /it``"),
        ["no reader types the command 'rostopic ehco /it'"],
    ),
    "a command that is typed now": (
        PAGE,
        (".. code-block:: bash\n", ".. terminal:: 1\n"),
        ["untyped.txt:1: WARNING: no page has the command 'sudo make install', which is listed"],
    ),
    "what a console shows": (
        OUTPUTS,
        ('1", "data: 2', '2", "data: 1'),
        ["expected in it: ['^data"],
    ),
    "a value": (
        LAUNCH,
        ('"7"', '"8"'),
        ["page: It waits for 8 s.", "test: It waits for 7 s."],
    ),
    "the name of a value": (
        PAGE,
        ("waiter.seconds", "waiter.second"),
        ["one.rst:4: ERROR: value: expected a name such as seconds; found second"],
    ),
    "a proved sentence in the list": (
        LIST,
        ("See the API.", "See the API.\nIs it so?"),
        ["This sentence has a proof: delete it from the list"],
    ),
}


@proves(
    "The test quotes the sentence word for word: if one of the two is changed alone, the build of "
    "the pages fails.",
)
@pytest.mark.parametrize("name", CHANGES)
def test_what_changes_alone_fails_the_build(root, name):
    file, (old, new), expected = CHANGES[name]
    change(root, file, old, new)
    code, said = build(root)
    assert code != 0
    for text in expected:
        assert text in said


def test_a_number_that_is_typed_fails_the_build(root):
    for file, end in ((PAGE, "named. Is"), (LIST, "is named.")):
        change(root, file, end, end.replace("named", "named by 7"))
    change(root, LIST, "[definition]", "[open]")
    code, said = build(root)
    assert code != 0 and "has a number that is typed, and no test proves it" in said
    assert "page: Paul N. Beuchat is named by 7." in said


def test_a_quote_is_checked_though_no_page_has_changed(root):
    assert build(root)[0] == 0
    change(root, PYTHON, "oldest", "newest")
    code, said = build(root)
    assert code != 0 and "test: A queue of 1.5 drops the newest value." in said


def test_the_function_that_counts_mutations_says_what_the_build_says(monkeypatch):
    monkeypatch.setattr(mutate_prose, "BUILDS", 1)
    assert mutate_prose.main("builds") is None


@proves("A small link at the end of a sentence leads to the test that proves it.")
def test_list_of_tests_shows_sentence_source_and_result(root):
    results = root / "catkin_ws/build/test_results/mrp"
    results.mkdir(parents=True)
    cases = '<testcase name="test_both"/><testcase name="test_publisher_py"><failure/></testcase>'
    (results / "rosunit-one.xml").write_text(f"<testsuite>{cases}</testsuite>")
    case = '<testcase classname="docker.test.test_run" name="test_it@group"/>'
    (results / "containers.xml").write_text(f"<testsuite>{case}</testsuite>")
    (results / "pytest_begun.xml").touch()  # as while the test runs that writes it
    code, said = build(root)
    assert code == 0, said
    page = (root / "site/pages/tests.html").read_text()
    assert '<a class="reference internal" href="one.html#one">A queue of 1.5 drops the' in page
    assert "What it does." in page and "proves" not in page
    for proof, result in [
        ("mrp/one/test_both", "passed"),
        ("mrp/one/test_publisher_py", "failed"),
        ("broken/one", "not run here"),
        ("docker/test_run/test_it", "passed"),
    ]:
        assert f"<strong>{proof}</strong>: {result}" in page
