# SPDX-License-Identifier: BSD-3-Clause
"""Each command on a page is typed by the reader of tools/run_page.py, or listed with a reason.

A command is each line of a block in bash, and a text in code that begins with one of PROGRAMS and
has more than this one word. The beginning of a typed command counts as typed. The file untyped.txt
has all others, each under the reason why not. What no page has, or a reader types, may not stand
there.
"""

import pathlib

import claims
from docutils import nodes
from sentences import plain
from sphinx.util import logging

LIST = pathlib.Path(__file__).resolve().parents[1] / "untyped.txt"
PROGRAMS = """
adduser apt-get catkin_create_pkg catkin_make cd chmod docker export git kill make mkdir nano
rosbag roscore roslaunch rosmsg rosnode rosparam rosrun rosservice rostopic source su sudo
""".split()

logger = logging.getLogger(__name__)


def of(document):
    """Return (command, line) of the commands that a page shows, but those in its terminals.

    What a directive has made from data is left out: the launch files of the labs have their tests.
    """
    found = []
    for node in document.findall(lambda one: isinstance(one, (nodes.literal, nodes.literal_block))):
        if "terminal" in node["classes"] or _is_generated(node):
            continue
        if node.get("language") == "bash":
            lines = filter(str.strip, node.astext().splitlines())
            found += [(plain(line), node.line) for line in lines]
        elif isinstance(node, nodes.literal):
            words = node.astext().split()
            if len(words) > 1 and words[0] in PROGRAMS:
                found.append((plain(" ".join(words)), node.parent.line))
    return found


def _is_generated(node):
    while node is not None and not node.get("generated"):
        node = node.parent
    return node is not None


def faults(shown, typed, listed):
    """Yield (what is wrong, its page or None, the line or None).

    shown: page -> what of() returns
    typed: the commands that the reader types
    listed: command -> reason
    """

    def is_typed(command):
        return command in typed or any(one.startswith(f"{command} ") for one in typed)

    on_pages = {command for commands in shown.values() for command, _ in commands}
    for page, commands in shown.items():
        for command, line in commands:
            if not is_typed(command) and command not in listed:
                yield (
                    f"no reader types the command {command!r}, and no reason is listed",
                    page,
                    line,
                )
    for command in listed:
        if command not in on_pages:
            yield f"no page has the command {command!r}, which is listed", None, None
        elif is_typed(command):
            yield f"a reader types the command {command!r}, which is listed", None, None


def _begin(app, env, docnames):
    if not hasattr(env, "mrp_commands"):
        env.mrp_commands = {}


def _collect(app, doctree):
    app.env.mrp_commands[app.env.docname] = of(doctree)


def _forget(app, env, docname):
    if hasattr(env, "mrp_commands"):
        env.mrp_commands.pop(docname, None)


def _check(app, env):
    steps = [step for its in env.mrp_steps.values() for step in its]
    typed = {plain(command) for step in steps for command in step.get("commands", ())}
    for what, page, line in faults(env.mrp_commands, typed, claims.read_list(LIST)):
        logger.warning(
            "%s: see untyped.txt", what, location=(page, line) if page else "untyped.txt:1"
        )


def setup(app):
    app.connect("env-before-read-docs", _begin)
    app.connect("doctree-read", _collect)
    app.connect("env-purge-doc", _forget)
    app.connect("env-updated", _check)
    return {"parallel_read_safe": False, "env_version": 1}
