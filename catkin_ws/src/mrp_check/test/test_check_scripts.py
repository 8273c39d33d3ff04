# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about scripts: their first lines, their modes, and what they are called."""

import types

import check_rules
import pytest
from check_rules import CMAKE, NODE, file_findings, told
from mrp_check.rules.files import scripts

pytestmark = pytest.mark.quick

WITHOUT = types.SimpleNamespace(is_contract=False, nodes={})


@pytest.mark.parametrize(
    ("first", "is_wrong"),
    [
        ("#!/usr/bin/env python", None),  # only where nothing else starts it
        ("#!/usr/bin/env python3", False),
        ("#!/usr/bin/python3", False),
        ("#! /usr/bin/python3 -u", False),
        ("#!/usr/bin/env -S python3 -u", False),
        ("#!/usr/bin/env python2", True),
        ("#!/usr/bin/env pyhton", True),
        ("#!/usr/bin/pyhton3", True),
        ("#!no_python", True),
        ("#!/bin/bash", True),
        ("# no shebang", True),
        ("\n#!/usr/bin/env python", True),
    ],
    ids=range(12),
)
@pytest.mark.parametrize("is_relayed", [True, False], ids=["relayed", "alone"])
@pytest.mark.parametrize("has_contract", [True, False], ids=["contract", "any"])
def test_first_line(first, is_wrong, is_relayed, has_contract, tmp_path):
    """Without a contract, it is no error where what catkin_install_python() makes starts it."""
    text_ = CMAKE if is_relayed else CMAKE.replace("catkin_install_python", "# ")
    source = f"{first}\nimport rospy\n"
    package = check_rules.make(tmp_path, src__odd_DOT_py=source, CMakeLists_DOT_txt=text_)
    known = {"spec": check_rules.PUB_SUB if has_contract else WITHOUT}
    known["started"] = {} if is_relayed else {"src/odd.py": None}
    found = [(f.severity, f.line) for f in file_findings(scripts, package, **known)]
    severity = "warning" if is_relayed and not has_contract else "error"
    assert found == [(severity, 1)] * (not is_relayed if is_wrong is None else is_wrong)


def test_what_asks_for_python_may_not_be_executable_either(tmp_path):
    text_ = CMAKE.replace("catkin_install_python", "# ")
    package = check_rules.make(
        tmp_path, src__even_DOT_py=NODE, src__odd_DOT_py=NODE, CMakeLists_DOT_txt=text_
    )
    (package.root / "src/odd.py").chmod(0o644)
    given = {"src/even.py": None, "src/odd.py": None}
    other, first, second = file_findings(scripts, package, started=given)
    assert "asks for 'python'" in first.message and "isn't executable," in second.message
    assert first.expected == other.expected  # the report tells it once, with both places


def test_a_copy_of_a_script_may_be_the_one_that_is_executable(tmp_path):
    text = NODE.replace("env python", "env python3")
    package = check_rules.make(tmp_path, src__odd_DOT_py=text, launch__odd_DOT_py=text)
    (package.root / "launch/odd.py").chmod(0o644)
    given = {"src/odd.py": None, "launch/odd.py": None}
    assert told(file_findings(scripts, package, started=given)) == []
    (package.root / "src/odd.py").chmod(0o644)
    assert len(told(file_findings(scripts, package, started=given))) == 1  # one is relayed


def test_relayed_script_that_is_not_executable(tmp_path):
    source = NODE.replace("env python", "env python3")
    package = check_rules.make(tmp_path, src__odd_DOT_py=source)
    (tmp_path / "src" / "odd.py").chmod(0o644)
    assert told(file_findings(scripts, package), "note") == [("scripts", 1)]


def test_script_that_hides_a_module_of_rospys(tmp_path):
    source = NODE.replace("env python", "env python3")
    package = check_rules.make(tmp_path, src__logging_DOT_py=source, src__odd_DOT_py=source)
    findings = file_findings(scripts, package)
    assert [(f.file, f.severity) for f in findings] == [("src/logging.py", "error")]


@pytest.mark.parametrize("name", ["odd.py.save.1", "odd.py~", "odd.py.bak", "#odd.py#"])
def test_what_an_editor_keeps_is_no_script(name, tmp_path):
    package = check_rules.make(
        tmp_path, **{f"src__{name}": "#!/usr/bin/env python\nimport rospi\n"}
    )
    assert package.files == ["CMakeLists.txt", "package.xml", f"src/{name}"]
    assert package.of_kind("python") == []
