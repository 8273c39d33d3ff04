# SPDX-License-Identifier: BSD-3-Clause
"""Small packages for the tests of the checker's rules: a rule sees the files, nothing is built."""

import html.parser
import os
import pathlib
import subprocess
import types

from mrp_check import sandbox
from mrp_check.code import facts, python_facts, python_read, source_node, uses
from mrp_check.confined import cpp_headers, crossing
from mrp_check.confined.places import Said
from mrp_check.contract import spec
from mrp_check.contract.requirements import Rule
from mrp_check.package import cmake, manifest
from mrp_check.package.package import Package
from mrp_check.rules import OF_CONTRACT
from mrp_check.rules.code import (
    callbacks,
    lifetime,
    node_start,
    not_called,
    python_names,
    rospy_calls,
    spin,
    typed,
)
from mrp_check.rules.contract import counter, queue, swapped_sources
from mrp_check.run import case
from mrp_check.verdict.severity import severity

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>some_pkg</name>
  <version>0.1.0</version>
  <description>A package.</description>
  <maintainer email="someone@some.example">Someone</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>roscpp</depend>
  <depend>rospy</depend>
  <depend>std_msgs</depend>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.10)
project(some_pkg)
find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs)
catkin_package(CATKIN_DEPENDS roscpp rospy std_msgs)
catkin_install_python(PROGRAMS src/odd.py DESTINATION bin)
"""
NODE = (
    "#!/usr/bin/env python\nimport rospy\nfrom std_msgs.msg import UInt32\nrospy.init_node('a')\n"
)
PUB_SUB = spec.read(spec.find("pub_sub"))
# How commands are confined here, and as root wherever it is; otherwise nothing is promised.
_OF_ROOT = sandbox.isolation() if os.getuid() else sandbox.Isolation.USER
ISOLATIONS = [*dict.fromkeys([sandbox.isolation(), _OF_ROOT])]
ASKED = {id_: requirement for id_, requirement in OF_CONTRACT.items() if PUB_SUB.asks(id_)}


def make(folder, **files):
    """Make a package of files (double underscores stand for slashes, one for a dot); return it."""
    folder = pathlib.Path(folder)
    given = {"package.xml": MANIFEST, "CMakeLists.txt": CMAKE}
    given.update({name.replace("__", "/").replace("_DOT_", "."): f for name, f in files.items()})
    for name, content in given.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        if name.endswith((".py", ".sh")):
            path.chmod(0o755)
    return Package(folder)


def hand_in(folder, name, cmake="cmake_minimum_required(VERSION 3.10)\n"):
    """Make a submission to a class, with little more than a manifest; return its folder."""
    return make(folder / name, CMakeLists_DOT_txt=cmake).root


class Tags(html.parser.HTMLParser):
    """The tags and the texts of a page; it fails where one is not closed."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.open = [], [], []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

    @property
    def text(self):
        return "".join(self.texts)


def case_of(package, folder, contract=PUB_SUB, **known):
    """Return a Case for a package in a new folder; close its `catkin` in the end.

    known: what it is to be taken to know already, such as facts
    """
    folder.mkdir()
    case_ = case.Case(package, contract, folder, 120, lambda sentence: None)
    vars(case_).update(known)
    return case_


def said_by_clang(folder, headers="none", flags=(cpp_headers.STANDARD,)):
    """Return what cpp_facts.py says of src/a.cpp in a folder; headers: ROS's, read before."""
    program = pathlib.Path(cpp_headers.__file__).with_name("cpp_facts.py")
    command = ["/usr/bin/python3", program, folder, headers, folder / "src/a.cpp", *flags]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return crossing.from_json(Said, done.stdout)


def model_of(package):
    """Return what CMakeLists.txt says, read as text."""
    text = package.text("CMakeLists.txt")
    calls = cmake.parsed(text, "CMakeLists.txt")
    model = cmake.Model(package.root, calls, complete=True)
    uses.is_installed.cache_clear()
    return model


def file_findings(rule, package, part=None, **known):
    """Return what a rule, or a part of it, says of a package of which only the files are known.

    known: what the rule knows in addition, such as started
    """
    given = {"manifest": manifest.parse(package), "model": model_of(package), "launch": None}
    given.update({"spec": PUB_SUB, "started": {}, **known})
    given.setdefault("launches", [given["launch"]] if given["launch"] else [])
    return [*of(rule.RULE, types.SimpleNamespace(package=package, **given), part)]


def python_findings(folder, source, **others):
    """Return the findings of the Python rules about a source, that of a file src/odd.py."""
    package = make(folder, src__odd_DOT_py=source, **others)
    read, problem = python_read.read(package, "src/odd.py")
    if problem:
        problem.severity = "error"
        return [problem]
    known = facts.Facts(python={read.file: read}, relevant=[read.file])
    case_ = types.SimpleNamespace(package=package, facts=known, coded=[])
    rules = python_names, rospy_calls, not_called, callbacks, typed
    return [finding for file in rules for finding in of(file.RULE, case_)]


def of(rule, case_, part=None):
    """Yield what a rule finds; it has to name each of its ids, as the checker asks for them.

    part: the function that is asked, if it is only a part of the rule
    """
    if part:
        rule = Rule(rule.stage, (), part, also=rule.ids, sure=rule.sure)
    for finding in rule.ask(case_):
        finding.severity = severity(finding.certainty, has_contract=True)
        yield finding


def node_findings(package, model, found):
    """Return what the rules say of the nodes of pub_sub whose sources say that (facts.Facts)."""
    coded = source_node.nodes(package, PUB_SUB, model, None, found)
    case_ = types.SimpleNamespace(coded=coded, facts=facts.Facts(), package=package)
    rules = swapped_sources, node_start, spin, queue, lifetime, callbacks, counter
    return [finding for file in rules for finding in of(file.RULE, case_)]


def python_facts_of(folder, source):
    """Return the Facts of a package whose node publisher_py_node is the source."""
    package = make(folder, src__odd_DOT_py=source)
    read, problem = python_read.read(package, "src/odd.py")
    assert problem is None
    found = facts.Facts(places=python_facts.places(read))
    found.sources["publisher_py_node"] = ["src/odd.py"]
    return package, found


def told(findings, *severities):
    """Return (id, line) of the findings with these severities; of errors and warnings if none."""
    severities = severities or ("error", "warning")
    return [(finding.id, finding.line) for finding in findings if finding.severity in severities]
