# SPDX-License-Identifier: BSD-3-Clause
"""The checker's rules about scripts: their first lines, their modes, and what they are called."""

import types

import check_rules
import pytest
from check_rules import CMAKE, file_findings, told
from mrp_check.rules.files import scripts

pytestmark = pytest.mark.quick

NODE = (
    "#!/usr/bin/env python\nimport rospy\nfrom std_msgs.msg import UInt32\nrospy.init_node('a')\n"
)


@pytest.mark.parametrize(
    ("first", "cmake_text", "expected"),
    [
        ("#!/usr/bin/env python", CMAKE, []),
        ("#!/usr/bin/env python3", "", []),
        ("#!/usr/bin/python3", "", []),
        ("#! /usr/bin/python3 -u", "", []),
        ("#!/usr/bin/env -S python3 -u", "", []),
        ("# no shebang", CMAKE, [("scripts", 1)]),
        ("#!/usr/bin/env pyhton", CMAKE, [("scripts", 1)]),
        ("#!/usr/bin/pyhton3", "", [("scripts", 1)]),
        ("#!/bin/bash", CMAKE, [("scripts", 1)]),
        ("\n#!/usr/bin/env python", CMAKE, [("scripts", 1)]),
    ],
    ids=range(10),
)
def test_first_line(first, cmake_text, expected, tmp_path):
    text_ = CMAKE if cmake_text else CMAKE.replace("catkin_install_python", "# ")
    source = first + NODE[NODE.index("\n") :]
    package = check_rules.make(tmp_path, src__odd_DOT_py=source, CMakeLists_DOT_txt=text_)
    found = file_findings(scripts, package, started={"src/odd.py": None})
    assert told(found) == expected


def test_what_asks_for_python_may_not_be_executable_either(tmp_path):
    text_ = CMAKE.replace("catkin_install_python", "# ")
    package = check_rules.make(tmp_path, src__odd_DOT_py=NODE, CMakeLists_DOT_txt=text_)
    (package.root / "src/odd.py").chmod(0o644)
    first, second = file_findings(scripts, package, started={"src/odd.py": None})
    assert "asks for 'python'" in first.message and "isn't executable," in second.message


def test_a_copy_of_a_script_may_be_the_one_that_is_executable(tmp_path):
    text = NODE.replace("env python", "env python3")
    package = check_rules.make(tmp_path, src__odd_DOT_py=text, launch__odd_DOT_py=text)
    (package.root / "launch/odd.py").chmod(0o644)
    given = {"src/odd.py": None, "launch/odd.py": None}
    assert told(file_findings(scripts, package, started=given)) == []
    (package.root / "src/odd.py").chmod(0o644)
    assert len(told(file_findings(scripts, package, started=given))) == 1  # one is relayed


@pytest.mark.parametrize(("is_relayed", "severity"), [(True, "warning"), (False, "error")])
def test_without_a_contract_a_relayed_script_needs_no_first_line(is_relayed, severity, tmp_path):
    text_ = CMAKE if is_relayed else CMAKE.replace("catkin_install_python", "# ")
    source = NODE[NODE.index("\n") + 1 :]
    package = check_rules.make(tmp_path, src__odd_DOT_py=source, CMakeLists_DOT_txt=text_)
    spec = types.SimpleNamespace(is_contract=False, nodes={})
    (finding,) = file_findings(scripts, package, started={"src/odd.py": None}, spec=spec)
    assert (finding.severity, finding.line) == (severity, 1)


@pytest.mark.parametrize(("by", "severity"), [("catkin_install_python", "note"), ("# ", "error")])
def test_script_that_is_not_executable(by, severity, tmp_path):
    text_ = CMAKE.replace("catkin_install_python", by)
    source = NODE.replace("env python", "env python3")
    package = check_rules.make(tmp_path, src__odd_DOT_py=source, CMakeLists_DOT_txt=text_)
    (tmp_path / "src" / "odd.py").chmod(0o644)
    assert told(file_findings(scripts, package), severity) == [("scripts", 1)]


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
