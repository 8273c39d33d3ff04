# SPDX-License-Identifier: BSD-3-Clause
"""The ledgers of the pages: the build marks what they name, and fails where they are wrong.

The pages here are small ones, in a small workspace of their own with the real extension.
"""

import html
import re
import shutil
import subprocess

import check_proofs
import pytest
import run_page
from check_proofs import cases, ledger
from docutils.core import publish_doctree

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
    "catkin_ws/src/mrp/test/test_one.cpp": "// SPDX\n// Blocks.\n\nTEST(One, publisherCpp)\n{\n}\n",
    "catkin_ws/src/mrp_check/defects/one.patch": (
        "Breaks: it\nFails: one.test test_both\nSays: it\n\n--- a/src/one.cpp\n+++ b/src/one.cpp\n"
    ),
    "docker/test/test_run.py": '"""Of the file."""\n\ndef test_it():\n    pass\n',
}


@pytest.fixture
def root(tmp_path):
    """The folder of a small repository, whose pages build."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / PYTHON).chmod(0o755)  # a program, which rostest runs
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(run_page.DOC / "extension", tmp_path / PAGES / "extension", ignore=ignore)
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
    cases = '<testcase name="test_both"><failure/></testcase>'
    (results / "rosunit-one.xml").write_text(f"<testsuite>{cases}</testsuite>")
    assert build(root) == (0, "")
    page = (root / "site/pages/one.html").read_text()
    assert "4 claims proved." in page
    # One mark for both sentences, at the end of their paragraph.
    texts = ["A queue of 1.5 drops the oldest value. Is it so?", 'It "never" blocks.']
    labels = [html.unescape(label) for label in re.findall('aria-label="(Proved: .*?)">', page)]
    assert labels == [f"Proved: {text}" for text in (*texts, "It blocks: at once.")]
    assert re.search(r'claims nothing. <button class="proof" popovertarget="proof-0"', page)
    _, *boxes = re.split(r'<div popover id="proof-', page)
    for text in (
        "<blockquote>A queue of 1.5 drops the oldest value.</blockquote>",
        "<strong>mrp/one/test_both</strong> failed on 20",
        "Sends\ntwo values.",
        "test_one.py, line 2",
        # It hasn't run here.
        "<strong>docker/test_run/test_it</strong> <br>Of the file.",
    ):
        assert text in boxes[0]
    assert "<strong>mrp/one/publisherCpp</strong> <br>Blocks." in boxes[2]
    assert "it" in boxes[2] and "one.patch, line 1" in boxes[2]
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
    code, printed = build(root)
    assert code != 0
    for text in expected:
        assert text in printed


@pytest.mark.slow  # needs Sphinx
def test_a_ledger_without_a_page_fails_the_build(root):
    (root / LEDGER).rename(root / PAGES / "proofs" / "two.txt")
    code, printed = build(root)
    assert code != 0 and "two.txt:1: WARNING: there is no page two" in printed


@pytest.mark.parametrize(
    ("text", "row", "expected"),
    [
        ("One. Two? *Three*!", "Two?", ["Two?"]),
        ("One line\nand **one** more.", "One line ... more.", ["One line and one more."]),
        ("It drops one. It sends two.", "It ... two.", ["It sends two."]),
        ("It drops one. It sends two.", "It drops ...", ["It drops one."]),
        ("It drops. It drops.", "It drops.", ["It drops.", "It drops."]),
        ("It drops the oldest.", "It drops", []),
        ("It drops the oldest.", "drops the oldest.", []),
        ('He says "no." Then.', 'He says "no."', ['He says "no."']),
        ("A ``b. C`` is a name.", "A b. C is a name.", ["A b. C is a name."]),
        ("- One\n- Two", "Two", ["Two"]),
        ("::\n\n   Code. It is.\n\n.. It is.", "It is.", []),
        ("===  ====\nOne  Two.\n===  ====", "Two.", ["Two."]),
    ],
)
def test_which_sentences_a_row_names(text, row, expected):
    blocks = ledger.blocks(publish_doctree(text))
    row = ledger.Row(row, 1, ("a",))
    assert [found for block in blocks for found in row.in_text(block.text)] == expected


def test_readme_is_read_without_its_markup(tmp_path):
    path = tmp_path / "README.md"
    path.write_text("# A *head*\n\n- One\n- `Two` [of](x.md)\n\n| a | b |\n")
    texts = [block.text for block in ledger.blocks_of_markdown(path)]
    assert texts == ["A head", "One", "Two of", "", "a", "b", ""]


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
    assert [found.language for found in cases.in_file(path).values()] == [language]


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder for files of results."""
    monkeypatch.setattr(cases, "RESULTS", tmp_path)
    cases.ended.cache_clear()
    yield tmp_path
    cases.ended.cache_clear()


def test_results_of_rostest_and_pytest(results):
    files = {
        "mrp/rosunit-stop.xml": """
            <testcase name="test_a"/>
            <testcase name="test_b"><error/></testcase>""",
        "pytest_slow.xml": """
            <testcase classname="test_broken" name="test_broken_variant_fails[e05]"/>
            <testcase classname="test_broken" name="test_broken_variant_fails[e06]"><failure/>
            </testcase>
            <testcase classname="test_lab" name="test_lab_shows_its_claim[latch]"/>
            <testcase classname="test_lab" name="test_lab_shows_its_claim[latch_restart]"><failure/>
            </testcase>
            <testcase classname="a.test_a" name="test_b[1]"/>
            <testcase classname="a.test_a" name="test_b[2]"><skipped/></testcase>""",
        "bookworm/containers.xml": '<testcase classname="a.test_run" name="test_c@group"/>',
    }
    for file, text in files.items():
        (results / file).parent.mkdir(exist_ok=True)
        (results / file).write_text(f"<testsuite>{text}</testsuite>")
    (results / "pytest_begun.xml").touch()  # as while the test runs that writes it
    expected = {
        "mrp/stop/test_a": "passed",
        "mrp/stop/test_b": "failed",
        "broken/e05": "passed",
        "broken/e06": "failed",
        "lab/latch": "passed",
        "lab/latch_restart": "failed",
        "workspace/test_a/test_b": "skipped",
        "docker/test_run/test_c": "passed",
    }
    assert {name: cases.result(name)[0] for name in expected} == expected
    assert cases.result("workspace/test_a/test_c") is None


def test_a_test_that_has_not_passed_is_named_with_its_line(results, monkeypatch):
    """What runs in containers or in `make test-check` is left out."""
    good, failed, skipped, sets = [f"workspace/test_it/test_{name}" for name in "abcd"]
    path = results / "one.txt"
    lines = [good, " A.", failed, skipped, " B.", sets, "docker/test_it/test_a", " C."]
    path.write_text("\n".join(lines))
    file = results / "test_it.py"
    file.write_text("pytestmark = pytest.mark.slow\n")
    names = [good, failed, skipped, "docker/test_it/test_a"]
    tests = dict.fromkeys(names, cases.Case(file, 1, "", "", ""))
    tests[sets] = cases.Case(file, 1, "", "", "@pytest.mark.sets")
    monkeypatch.setattr(cases, "find", tests.get)
    xml = '<testcase classname="test_it" name="test_{}">{}</testcase>'
    cases_run = xml.format("a", "") + xml.format("c", "<skipped/>")
    (results / "pytest_slow.xml").write_text(f"<testsuite>{cases_run}</testsuite>")
    assert list(check_proofs.faults(results)) == [
        f"{path}:5: not run: {failed}, in {file}",
        f"{path}:5: skipped: {skipped}, in {file}",
    ]
