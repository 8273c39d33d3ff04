# SPDX-License-Identifier: BSD-3-Clause
"""Role `value`: a number or a name that a page takes from where it is defined.

:value:`contract.QUEUE_SIZE`                    the contract: mrp_testing/contract.py
:value:`loop_spin_once.publisher_cpp.period`    a launch file: NODE.PARAMETER, or an argument
:value:`rospy.topics.DEFAULT_BUFF_SIZE`         ROS's own default, in a module of ROS

The text is an expression in Python, such as `contract.QUEUE_SIZE + 1` or `len(latch.nodes)`. There
`word(...)` writes a number as a word.
"""

import importlib
import logging
import re
import sys
import xml.etree.ElementTree as ElementTree

from cases import WORKSPACE
from docutils import nodes
from sphinx.util.docutils import SphinxRole

ROS = ("rospy", "rosmaster")
WORDS = "zero one two three four five six seven eight nine ten eleven twelve".split()
FILES = ("mrp/launch/*.launch", "mrp_labs/launch/*.*")


class Names(dict):
    """What has names: each is an attribute, too."""

    def __getattr__(self, name):
        if name not in self:
            raise AttributeError(name)
        return self[name]


class Sources(dict):
    """The names with which an expression may begin. used: the files that were read for it."""

    def __init__(self, folder=WORKSPACE / "src"):
        super().__init__(len=len, word=lambda number: WORDS[int(number)])
        self.used = set()
        self.files = {path.stem: path for pattern in FILES for path in folder.glob(pattern)}
        self.modules = {"contract": "mrp_testing.contract", **{name: name for name in ROS}}
        sys.path.insert(0, str(folder / "mrp_testing" / "src"))

    def __missing__(self, name):
        if name in self.modules:
            logging.getLogger(name).setLevel(logging.WARNING)  # rospy logs that it is imported
            found = importlib.import_module(self.modules[name])
            self.used.add(found.__file__)
            return found
        self.used.add(str(self.files[name]))
        return read(self.files[name])


def read(path):
    """Return what a launch file says."""
    root = ElementTree.parse(path).getroot()
    args = {arg.get("name"): _typed(arg.get("default", "")) for arg in root.iter("arg")}
    found = Names(args, nodes=[])
    _add(root, found, {})
    return found


def _add(element, found, private):
    """Add the nodes of a <launch> or <group>. private: parameters of all nodes that follow."""
    private = dict(private)
    for child in element:
        if child.tag == "param" and child.get("name").startswith("~"):
            private[child.get("name")[1:]] = _value(child, found)
        elif child.tag == "node":
            own = {param.get("name"): _value(param, found) for param in child.iter("param")}
            found[child.get("name")] = Names({**private, **own})
            found["nodes"].append(child.get("name"))
        elif child.tag == "group":
            _add(child, found, private)


def _value(param, args):
    value = param.get("value", "")
    return _typed(re.sub(r"\$\(arg (\w+)\)", lambda match: _shown(args[match.group(1)]), value))


def _typed(text):
    """Return a text, as a number if it is one."""
    return float(text) if re.fullmatch(r"-?\d+(\.\d+)?", text) else text


def _shown(value):
    return str(int(value)) if isinstance(value, float) and value == int(value) else str(value)


def value_of(text, sources):
    """Return the text for an expression. Raises whatever is wrong with it."""
    found = eval(text, {"__builtins__": {}}, sources)
    if not isinstance(found, (int, float, str)):
        raise TypeError(f"expected a number or a text, found {found!r}")
    return _shown(found)


class ValueRole(SphinxRole):
    def run(self):
        sources = Sources()
        try:
            text = value_of(self.text, sources)
        except Exception as error:
            message = self.inliner.reporter.error(f"value: {error!r}", line=self.lineno)
            return [self.inliner.problematic(self.rawtext, self.rawtext, message)], [message]
        for file in sources.used:
            self.env.note_dependency(file)
        return [nodes.inline(self.rawtext, text)], []


def setup(app):
    app.add_role("value", ValueRole())
    return {"parallel_read_safe": False}
