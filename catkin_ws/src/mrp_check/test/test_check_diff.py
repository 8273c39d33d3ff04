# SPDX-License-Identifier: BSD-3-Clause
"""Applies the checker's own fixes with patch, and checks again: the finding is gone."""

import subprocess

import check_rules
import pytest
from mrp_check.verdict import diff
from test_check_python import TIMER, replaced

pytestmark = pytest.mark.quick


def patched(folder, text):
    """Apply a diff as a student would."""
    subprocess.run(
        ["patch", "-p1", "--fuzz=0"], cwd=folder, input=text + "\n", text=True, check=True
    )


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (TIMER, "rospy.Timer(0.5, self.callback)"),
        (TIMER, "rospy.Timer(rospy.Duration(0.5), self.callback(None))"),
        ("    rospy.spin()", "    rospy.spin"),
    ],
    ids=["number", "called", "not_called"],
)
def test_finding_is_gone(old, new, tmp_path):
    findings = check_rules.python_findings(tmp_path, replaced(old, new))
    (finding,) = [finding for finding in findings if not finding.consequence_of]
    package = check_rules.Package(tmp_path)
    patched(tmp_path, diff.of_change(package, finding.file, finding.line, finding.change))
    assert (tmp_path / "src/odd.py").read_text() == replaced(old, old)


def test_line_can_be_added(tmp_path):
    package = check_rules.make(tmp_path)
    line = package.find_line("package.xml", ">rospy<")
    old = package.lines("package.xml")[line - 1]
    patched(tmp_path, diff.of_change(package, "package.xml", line, (old, old + "\n  <depend/>")))
    mended = check_rules.MANIFEST.replace("rospy</depend>\n", "rospy</depend>\n  <depend/>\n")
    assert (tmp_path / "package.xml").read_text() == mended


@pytest.mark.parametrize(
    ("content", "old"),
    [
        (b"one one\n", "one"),
        (b"two\n", "one"),
        (b"one\r\n", "one"),
        (b"\xef\xbb\xbfone\n", "one"),
        (b"one \xfc\n", "one"),
        (b"one", "one"),
    ],
    ids=["twice", "not_there", "windows", "byte_order_mark", "no_utf8", "no_last_newline"],
)
def test_no_diff_that_might_be_wrong_or_not_fit(content, old, tmp_path):
    package = check_rules.make(tmp_path, file=content)
    assert diff.of_change(package, "file", 1, (old, "other")) == ""
