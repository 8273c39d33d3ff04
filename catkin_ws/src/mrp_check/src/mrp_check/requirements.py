# SPDX-License-Identifier: BSD-3-Clause
"""All requirements in one table: what a package must meet, and which page explains it."""

from __future__ import annotations

import typing

STAGES = ("files", "static", "build", "run", "stop")


class Requirement(typing.NamedTuple):
    stage: str  # in whose group it is shown, and which must have run to call it met
    title: str  # a sentence that is true of a package which meets it
    section: str  # page of the tutorial, and the anchor on it
    also: tuple = ()  # the other stages that may find it broken


REQUIREMENTS = {
    # files
    "manifest": Requirement("files", "package.xml is complete and valid", "building#package-xml"),
    "dependencies": Requirement(
        "files",
        "Each package that the code uses is declared in package.xml and CMakeLists.txt",
        "building#package-xml",
        ("static", "build"),
    ),
    "package-name": Requirement(
        "files", "The package has one name, in package.xml, CMake and launch file", "package"
    ),
    "cmake": Requirement(
        "files", "CMakeLists.txt is a catkin package's", "building#cmakelists-txt", ("build",)
    ),
    "targets": Requirement(
        "files",
        "Each executable is built of its own sources",
        "wrong#a-target-is-made-of-another-node-s-source",
        ("static", "build"),
    ),
    "messages": Requirement("files", "The package's own messages are generated", "message_types"),
    "scripts": Requirement(
        "files",
        "Each script is there, executable, and can be started",
        "wrong#the-script-is-not-executable",
        ("build", "run"),
    ),
    "text": Requirement("files", "Each file is plain UTF-8 text with Unix line ends", "wrong"),
    "launch-file": Requirement(
        "files", "The launch file is there and roslaunch can read it", "launching", ("run",)
    ),
    "launch-nodes": Requirement(
        "files", "The launch file starts each node under its name", "launching", ("run",)
    ),
    "launch-group": Requirement(
        "files", "The launch file puts the nodes into the group", "namespaces", ("run",)
    ),
    "launch-output": Requirement("files", "The nodes' lines come to the screen", "launching"),
    "install": Requirement("files", "What is needed to run is installed", "building"),
    # static
    "python-syntax": Requirement("static", "Python can read each script", "wrong", ("files",)),
    "python-names": Requirement(
        "static", "Each name in Python code exists", "wrong", ("files", "run")
    ),
    "node-start": Requirement("static", "Each node starts ROS first", "publisher", ("run",)),
    "node-name": Requirement(
        "static", "Each node gives itself its own name", "publisher#start-the-node", ("run",)
    ),
    "spin": Requirement("static", "Each node waits for callbacks", "publisher", ("run",)),
    "callbacks": Requirement(
        "static", "Each callback is handed over and takes what it gets", "subscriber", ("run",)
    ),
    "lifetime": Requirement(
        "static",
        "Publishers, subscribers and timers live as long as the node, and no longer",
        "subscriber",
        ("run", "stop"),
    ),
    "queue": Requirement("static", "Queues are long enough", "queues", ("run",)),
    # build
    "configure": Requirement("build", "CMake can configure the package", "building"),
    "compile": Requirement("build", "The C++ code compiles", "building#catkin-make"),
    "link": Requirement("build", "The executables can be linked", "building"),
    # run
    "starts": Requirement("run", "Each node starts and stays up", "launching"),
    "topic": Requirement(
        "run", "Publishers and subscribers meet on the topic", "publisher", ("static",)
    ),
    "type": Requirement("run", "The messages have the right type", "publisher", ("static",)),
    "values": Requirement("run", "Publishers publish the right values", "publisher", ("static",)),
    "wrap": Requirement(
        "run", "The values wrap round past the largest one", "publisher", ("static",)
    ),
    "rate": Requirement("run", "The rate is right", "publisher", ("static",)),
    "latch": Requirement("run", "Nothing is latched that should not be", "latch", ("static",)),
    "received": Requirement("run", "Subscribers hear every value", "subscriber", ("static",)),
    "console": Requirement("run", "The console shows the right lines", "launching", ("static",)),
    "namespace": Requirement(
        "run", "The nodes can be moved to another namespace", "namespaces", ("static",)
    ),
    "warnings": Requirement("run", "ROS prints no warnings", "wrong"),
    # stop
    "exit": Requirement("stop", "Each node ends cleanly on Ctrl-C", "launching", ("static",)),
    "leftovers": Requirement("stop", "Nothing is left when the nodes have ended", "launching"),
}


def of_stage(stage):
    """Return the ids of the requirements that are shown under a stage, in the table's order."""
    return [id_ for id_, requirement in REQUIREMENTS.items() if requirement.stage == stage]


def page_of(id_):
    """Return where a requirement is explained: a file of the built pages, and the place in it."""
    page, _, anchor = REQUIREMENTS[id_].section.partition("#")
    return f"pages/{page}.html" + (f"#{anchor}" if anchor else "")


def stages_for(ids):
    """Return the stages that must run to check these requirements, in their order."""
    needed = {stage for id_ in ids for stage in (REQUIREMENTS[id_].stage, *REQUIREMENTS[id_].also)}
    if "stop" in needed or "run" in needed:
        needed |= {"build"}
    return [stage for stage in STAGES if stage in needed]
