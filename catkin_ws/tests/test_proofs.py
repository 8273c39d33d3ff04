# SPDX-License-Identifier: BSD-3-Clause
"""The ledgers of the pages: the build marks what they name, and fails where they are wrong.

The pages here are small ones, in a small workspace of their own with the real extension.
"""

import html
import json
import re
import shutil
import subprocess

import check_proofs
import pytest
import run_page
from check_proofs import cases
from docutils.core import publish_doctree
from mrp_testing.workspace import WORKSPACE
from sentences import of

pytestmark = pytest.mark.quick

PAGES = "catkin_ws/src/mrp/doc"
PAGE = f"{PAGES}/pages/one.rst"
LEDGER = f"{PAGES}/proofs/one.txt"
README = f"{PAGES}/proofs/README.txt"
PYTHON = "catkin_ws/src/mrp/test/test_one.py"

FILES = {
    f"{PAGES}/conf.py": """\
import pathlib, sys
sys.path.insert(0, str(pathlib.Path(__file__).parent / "extension"))
extensions = ["sphinx_inline_tabs", "proofs"]
""",
    f"{PAGES}/index.rst": "Start\n=====\n\n.. toctree::\n\n   pages/one\n   pages/tests\n",
    f"{PAGES}/pages/tests.rst": "The tests\n=========\n\n.. tests::\n",
    PAGE: """\
One
===

A queue of ``1.5`` drops
the *oldest* value. Is it so? It claims nothing.

.. tab:: Python

   It "never" blocks.

.. tab:: C++

   It blocks: at once.
""",
    LEDGER: """\
# A comment.
mrp/one/test_both
docker/test_run/test_it
    A queue of 1.5 drops the oldest value.
docker/test_run/test_it
    Is it ...?

mrp/one/test_publisher_py
    It "never" blocks.
mrp/one/publisherCpp
broken/one
    It blocks: at once.
""",
    "README.md": "# It\n\nIt *runs* `a. B`.\n",
    README: "docker/test_run/test_it\n    It runs a. B.\n",
    PYTHON: '''\
class TestOne:
    def test_both(self):
        """Sends
        two values."""
        assert 1 < 2

    def test_publisher_py(self):
        pass
''',
    "catkin_ws/src/mrp/test/test_one.cpp": "// Blocks.\nTEST(One, publisherCpp)\n{\n}\n",
    "catkin_ws/src/mrp_check/defects/one.patch": (
        "Breaks: it\nFails: one.test test_both\nSays: it\n\n--- a/src/one.cpp\n+++ b/src/one.cpp\n"
    ),
    "docker/test/test_run.py": "def test_it():\n    pass\n",
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
        [run_page.docs_python(), "-m", "sphinx", *options, root / PAGES, root / "site"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    return done.returncode, done.stdout


@pytest.mark.slow  # needs Sphinx
def test_marks_boxes_and_table_of_what_is_proved(root):
    results = root / "catkin_ws/build/test_results/mrp"
    results.mkdir(parents=True)
    cases = '<testcase name="test_both"/><testcase name="test_publisher_py"><failure/></testcase>'
    (results / "rosunit-one.xml").write_text(f"<testsuite>{cases}</testsuite>")
    assert build(root) == (0, "")
    page = (root / "site/pages/one.html").read_text()
    assert "4 claims proved." in page
    # One mark for both sentences, at the end of their paragraph.
    texts = ["A queue of 1.5 drops the oldest value. Is it so?", 'It "never" blocks.']
    labels = [html.unescape(label) for label in re.findall('aria-label="(Proved: .*?)">', page)]
    assert labels == [f"Proved: {text}" for text in (*texts, "It blocks: at once.")]
    assert re.search(r'claims nothing. <a class="proof" href="tests.html#tests-of-one"', page)
    script = (root / "site/_proofs/one.js").read_text()
    shown = json.loads(re.fullmatch(r'mrpProofs\["one"\] = (.*);\n', script)[1])
    assert shown["marks"][1] == [['It "never" blocks.', ["mrp/one/test_publisher_py"]]]
    both = shown["tests"]["mrp/one/test_both"]
    for text in ("passed", "Sends two values.", "test_one.py, line 2", "rostest mrp"):
        assert text in both
    assert "failed" in shown["tests"]["mrp/one/test_publisher_py"]
    table = (root / "site/pages/tests.html").read_text()
    assert '<a href="one.html#one">It blocks: at once.</a>' in table
    assert "<td>mrp/one/publisherCpp<br>broken/one</td>" in table


FAULTS = {
    "a typing error in a proved sentence": (
        PAGE,
        ("*oldest*", "*odlest*"),
        [
            "doc/proofs/one.txt:4: WARNING: the page has no such sentence: A queue of 1.5 drops",
            "The nearest: A queue of 1.5 drops the odlest value.",
        ],
    ),
    "a test that does not exist": (
        LEDGER,
        ("mrp/one/test_both", "mrp/one/test_bot"),
        ["one.txt:4: WARNING: there is no test mrp/one/test_bot", "The nearest: mrp/one/test_both"],
    ),
    "a sentence without a test": (
        LEDGER,
        ("mrp/one/test_both\ndocker/test_run/test_it\n", ""),
        ["one.txt:2: WARNING: expected the name of a test above this sentence"],
    ),
    "the other language's test": (
        LEDGER,
        ("mrp/one/test_publisher_py", "mrp/one/publisherCpp"),
        ["one.txt:9: WARNING: the sentence stands in the tab Python, and its tests are of the"],
    ),
    "a sentence of the README": (
        "README.md",
        ("*runs*", "stops"),
        ["proofs/README.txt:2: WARNING: the page has no such sentence: It runs a. B."],
    ),
}


@pytest.mark.slow  # needs Sphinx
@pytest.mark.parametrize("name", FAULTS)
def test_what_is_wrong_in_a_ledger_fails_the_build(root, name):
    file, (old, new), expected = FAULTS[name]
    text = (root / file).read_text()
    assert old in text
    (root / file).write_text(text.replace(old, new))
    code, said = build(root)
    assert code != 0
    for text in expected:
        assert text in said


@pytest.mark.slow  # needs Sphinx
def test_a_ledger_without_a_page_fails_the_build(root):
    (root / LEDGER).rename(root / PAGES / "proofs" / "two.txt")
    code, said = build(root)
    assert code != 0 and "two.txt:1: WARNING: there is no page two" in said


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("One. Two? *Three*!", ["One.", "Two?", "Three!"]),
        ("One line\nand **one** more.", ["One line and one more."]),
        ("Paul N. Beuchat, as in 3.5. But", ["Paul N. Beuchat, as in 3.5.", "But"]),
        ("A ``b. C`` is a name. No. 5 is.", ["A b. C is a name.", "No.", "5 is."]),
        ('He says "no." Then.', ['He says "no."', "Then."]),
        ("- One\n- Two", ["One", "Two"]),
        ("term\n   What it is.", ["term", "What it is."]),
        ("::\n\n   Code. It is.\n\n.. A comment.", []),
        ("Head\n====\n\nText\n\n===  ====\nOne  Two.\n===  ====", ["Head", "Text", "One", "Two."]),
    ],
)
def test_sentences(text, expected):
    assert [sentence.text for sentence in of(publish_doctree(text))] == expected


@pytest.mark.parametrize(
    ("case", "language"),
    [
        ("test_publisher_py", "Python"),
        ("test_cpp_twin", "C++"),
        ("test_copy", ""),
        ("test_happy_end", ""),
    ],
)
def test_language_of_a_test_case(tmp_path, case, language):
    path = tmp_path / "test_it.py"
    path.write_text(f"def {case}():\n    pass\n")
    assert [found.language for _, found in cases.python_cases(path)] == [language]


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
        '<testsuite><testcase classname="docker.test.test_run" name="test_c@group"/></testsuite>'
    )
    (tmp_path / "pytest_begun.xml").touch()  # as while the test runs that writes it
    assert cases.last_results(tmp_path) == {
        "mrp/stop/test_a": "passed",
        "mrp/stop/test_b": "failed",
        "broken/e05": "passed",
        "broken/e06": "failed",
        "workspace/test_a/test_b": "skipped",
        "docker/test_run/test_c": "passed",
    }


def test_a_test_that_has_not_passed_is_named_with_its_line(tmp_path):
    """What runs in containers or in `make test-check` is left out."""
    good, failed, skipped, sets = [f"workspace/test_it/test_{name}" for name in "abcd"]
    path = tmp_path / "one.txt"
    lines = [good, " A.", failed, skipped, " B.", sets, "docker/test_it/test_a", " C."]
    path.write_text("\n".join(lines))
    file = tmp_path / "test_it.py"
    file.write_text("pytestmark = pytest.mark.slow\n")
    names = [good, failed, skipped, "docker/test_it/test_a"]
    tests = dict.fromkeys(names, cases.Case(file, 1, "", "", ""))
    tests[sets] = cases.Case(file, 1, "", "", "@pytest.mark.sets")
    found = list(check_proofs.faults(tmp_path, tests, {good: "passed", skipped: "skipped"}))
    assert [fault.partition(" python3")[0] for fault in found] == [
        f"{path}:5: not run: {failed}:",
        f"{path}:5: skipped: {skipped}:",
    ]
