# SPDX-License-Identifier: BSD-3-Clause
"""The styles, which packages.py lays out: each makes a package, and a fault in one is a sentence.

test_check_sets.py builds and runs them.
"""

import xml.etree.ElementTree as ElementTree

import check_sets
import pytest
from mrp_check.contract import packages, resources, spec
from mrp_check.rules import REQUIREMENTS

pytestmark = pytest.mark.quick

OTHERS = check_sets.STYLES[1:]  # than the tutorial's

FIELDS = ("Base", "Without", "CRLF", "Spec", "Warns")
PATCH = """\
Style: some
Base: nothing

diff --git b/src/a.py b/src/a.py
new file mode 100755
--- /dev/null
+++ b/src/a.py
@@ -0,0 +1 @@
+first
"""


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


@pytest.fixture
def lay_out(tmp_path, monkeypatch):
    """A function that lays out a style of which the patch has this text."""
    monkeypatch.setattr(packages, "CORRECT", tmp_path)

    def of(text, style="some"):
        (tmp_path / f"{style}.patch").write_text(text)
        check_sets.lay_out(style, tmp_path / style)
        return tmp_path / style

    return of


def test_patch_replaces_files_of_its_base(lay_out):
    assert check_sets.contents(lay_out(PATCH)) == {"src/a.py": (True, b"first\n")}
    second = PATCH.replace("nothing", "some").replace("100755", "100644")
    assert check_sets.contents(lay_out(second.replace("first", "second"), "other")) == {
        "src/a.py": (False, b"second\n")
    }


def test_head_without_a_diff_changes_files_of_its_base(lay_out):
    lay_out(PATCH)
    lay_out(PATCH.replace("a.py", "b.py").replace("nothing", "some"), "two")
    folder = lay_out("Base: two\nWithout: src/a.py\nCRLF: src/b.py\n", "windows")
    assert check_sets.contents(folder) == {"src/b.py": (True, b"first\r\n")}


def test_diff_that_does_not_fit_is_named(lay_out):
    fault = r"some\.patch doesn't fit .* as packages\.py shows\. The command `patch` says: "
    with pytest.raises(packages.PatchError, match=fault):
        lay_out(PATCH.replace("+first", ""))
