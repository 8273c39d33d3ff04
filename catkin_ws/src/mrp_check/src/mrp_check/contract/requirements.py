# SPDX-License-Identifier: BSD-3-Clause
"""All requirements in one table: what a package must meet, and which page explains it."""

from __future__ import annotations

import typing

STAGES = ("files", "static", "build", "run", "stop")


class Requirement(typing.NamedTuple):
    stage: str  # in whose group it is shown
    title: str  # a sentence that is true of a package which meets it
    section: str  # page of the tutorial, and the anchor on it
    seen: str  # what must have been seen to call it met: a key of evidence.py


class Rule(typing.NamedTuple):
    """A rule, which can find requirements not met.

    ids: the requirements that it can report
    needs: what it looks at, names in NEEDS
    findings: called with a case.Case, yields a Finding for each thing that is wrong
    """

    ids: tuple
    needs: tuple
    findings: typing.Callable


# What a rule may need, a member of case.Case -> what that needs in turn.
NEEDS = {
    "manifest": (),
    "model": ("manifest",),
    "launch": ("manifest",),
    "facts": ("model", "launch"),
    "built": ("model",),
    "nodes": ("facts", "built"),
}


def closure(needs):
    """Return all that must be known for what is needed."""
    return {one for need in needs for one in (need, *closure(NEEDS[need]))}


REQUIREMENTS = {
    # files
    "manifest": Requirement(
        "files", "package.xml is complete and valid", "building#package-xml", "always"
    ),
    "dependencies": Requirement(
        "files",
        "Each package that the code uses is declared in package.xml and CMakeLists.txt",
        "building#package-xml",
        "code",
    ),
    "package-name": Requirement(
        "files",
        "The package has one name, in package.xml, CMake and launch file",
        "package",
        "manifest",
    ),
    "cmake": Requirement(
        "files", "CMakeLists.txt is a catkin package's", "building#cmakelists-txt", "always"
    ),
    "targets": Requirement(
        "files",
        "Each executable is built of its own sources",
        "wrong#a-target-is-made-of-another-node-s-source",
        "cpp",
    ),
    "messages": Requirement(
        "files", "The package's own messages are generated", "message_types", "cmake"
    ),
    "scripts": Requirement(
        "files",
        "Each script is there, executable, and can be started",
        "wrong#the-script-is-not-executable",
        "python",
    ),
    "text": Requirement(
        "files", "Each file is plain UTF-8 text with Unix line ends", "wrong", "always"
    ),
    "launch-file": Requirement(
        "files", "The launch file is there and roslaunch can read it", "launching", "always"
    ),
    "launch-nodes": Requirement(
        "files", "The launch file starts each node under its name", "launching", "launch"
    ),
    "launch-group": Requirement(
        "files", "The launch file puts the nodes into the group", "namespaces", "launch"
    ),
    "launch-output": Requirement(
        "files", "The nodes' lines come to the screen", "launching", "launch"
    ),
    "install": Requirement("files", "What is needed to run is installed", "building", "cmake"),
    # static
    "python-syntax": Requirement("static", "Python can read each script", "wrong", "python"),
    "python-names": Requirement(
        "static", "Each name in Python code exists", "wrong", "python-read"
    ),
    "node-start": Requirement("static", "Each node starts ROS first", "publisher", "read"),
    "node-name": Requirement(
        "static", "Each node gives itself its own name", "publisher#start-the-node", "read"
    ),
    "spin": Requirement("static", "Each node waits for callbacks", "publisher", "read"),
    "callbacks": Requirement(
        "static", "Each callback is handed over and takes what it gets", "subscriber", "read"
    ),
    "lifetime": Requirement(
        "static",
        "Publishers, subscribers and timers live as long as the node, and no longer",
        "subscriber",
        "read",
    ),
    "queue": Requirement("static", "Queues are long enough", "queues", "read"),
    # build
    "configure": Requirement("build", "CMake can configure the package", "building", "cmake"),
    "compile": Requirement("build", "The C++ code compiles", "building#catkin-make", "compiled"),
    "link": Requirement("build", "The executables can be linked", "building", "built"),
    # run
    "starts": Requirement("run", "Each node starts and stays up", "launching", "up"),
    "topic": Requirement(
        "run", "Publishers and subscribers meet on the topic", "publisher", "meets"
    ),
    "type": Requirement("run", "The messages have the right type", "publisher", "meets"),
    "values": Requirement("run", "Publishers publish the right values", "publisher", "values"),
    "wrap": Requirement("run", "The values wrap round past the largest one", "publisher", "wrap"),
    "rate": Requirement("run", "The rate is right", "publisher", "rate"),
    "latch": Requirement("run", "Nothing is latched that should not be", "latch", "messages"),
    "received": Requirement("run", "Subscribers hear every value", "subscriber", "received"),
    "console": Requirement("run", "The console shows the right lines", "launching", "up"),
    "namespace": Requirement(
        "run", "The nodes can be moved to another namespace", "namespaces", "alone"
    ),
    "warnings": Requirement("run", "ROS prints no warnings", "wrong", "alone"),
    # stop
    "exit": Requirement("stop", "Each node ends cleanly on Ctrl-C", "launching", "asked"),
    "leftovers": Requirement(
        "stop", "Nothing is left when the nodes have ended", "launching", "up"
    ),
}


def of_stage(stage):
    """Return the ids of the requirements that are shown under a stage, in the table's order."""
    return [id_ for id_, requirement in REQUIREMENTS.items() if requirement.stage == stage]


def page_of(id_):
    """Return where a requirement is explained: a file of the built pages, and the place in it."""
    page, _, anchor = REQUIREMENTS[id_].section.partition("#")
    return f"pages/{page}.html" + (f"#{anchor}" if anchor else "")
