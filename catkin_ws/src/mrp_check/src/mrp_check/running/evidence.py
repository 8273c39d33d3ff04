# SPDX-License-Identifier: BSD-3-Clause
"""What must have been seen to call a requirement met: without a finding, it may be unobserved."""

from __future__ import annotations

from mrp_check.contract.requirements import REQUIREMENTS
from mrp_check.running.node import Node, received_line


def unseen(case, ids):
    """Return id -> why nobody can say that the requirement is met, of those for which it is so."""
    found = {}
    for id_ in ids:
        key = REQUIREMENTS[id_].seen
        names = case.spec.nodes if key in _OF_NODES else [None]
        for name in names:
            why = _OF_NODES[key](case, name) if name else _OF_PACKAGE[key](case)
            if why and id_ not in found:
                found[id_] = why
    return found


def _built(case):
    if case.built is None:
        return "CMake did not succeed"
    return None if case.built.ok else "not everything was compiled"


_OF_PACKAGE = {
    "always": lambda case: None,
    "manifest": lambda case: None if case.manifest[0] else "package.xml cannot be read",
    "code": lambda case: (
        _OF_PACKAGE["manifest"](case)
        or (None if case.package.of_kind("python", "cpp") else "the package has no source")
    ),
    "cmake": lambda case: (
        None if "CMakeLists.txt" in case.package.files else "there is no CMakeLists.txt"
    ),
    "launch": lambda case: (
        None if case.launch and not case.launch.error else "roslaunch cannot read the launch file"
    ),
    "built": _built,
}


def _sources(case, name, language):
    """Say why nothing is known of a node's sources, if it may be in that language."""
    wanted = case.spec.nodes[name].language
    files = case.facts.sources.get(name)
    if wanted not in (language, "any") or wanted == "any" and files:
        return None
    return None if files else f"no source of {name} was found"


def _read(case, name):
    """Say why it is not known what a node's sources say, nor what the node does."""
    if "nodes" in vars(case) and case.nodes[name].is_up:
        return None
    files = case.facts.sources.get(name, [])
    unread = [file for file in files if file in case.facts.unread]
    if unread:
        return f"{unread[0]} cannot be read"
    return None if files else f"no source of {name} was found"


def _python_read(case, name):
    main = (case.facts.sources.get(name) or [None])[0]
    is_cpp = main and case.package.kind(main) == "cpp" or case.spec.nodes[name].language == "cpp"
    return None if is_cpp else _read(case, name)


def _compiled(case, name):
    if case.built is None:
        return "CMake did not succeed"
    return _sources(case, name, "cpp")


def _when(is_seen, what):
    """Return the test of a node that came up, and of which something more must have been seen."""

    def why(case, name):
        node = case.nodes[name]
        if not node.is_up:
            return f"{name} did not run"
        return None if is_seen(node) else f"{name} {what}"

    return why


def _of_publisher(asked, is_seen, what):
    """The same of a node that publishes, if its contract says more of it."""
    test = _when(is_seen, what)

    def why(case, name):
        role = case.spec.nodes[name].publishes
        return test(case, name) if role and asked(role) else None

    return why


def _values(case, name):
    wanted = case.spec.nodes[name]
    if wanted.relays:
        return _when(Node.sent, "was sent nothing")(case, name)
    seen = _of_publisher(lambda role: role.values, Node.published_numbers, "published no number")
    return seen(case, name)


def _received(case, name):
    seen = _when(lambda node: node.sent() and received_line(node), "logged no value")
    return seen(case, name) if case.spec.nodes[name].subscribes else None


_OF_NODES = {
    "python": lambda case, name: _sources(case, name, "python"),
    "cpp": lambda case, name: _sources(case, name, "cpp"),
    "python-read": _python_read,
    "read": _read,
    "compiled": _compiled,
    "up": _when(lambda node: True, ""),
    "meets": _when(Node.meets, "was not seen on its topic"),
    "values": _values,
    "rate": _of_publisher(lambda role: role.period, Node.has_rate, "published too few messages"),
    "messages": _of_publisher(lambda role: True, Node.published, "published no message"),
    "wrap": _of_publisher(
        lambda role: role.values and role.values.modulus,
        Node.has_wrapped,
        "has no counter that could be found",
    ),
    "received": _received,
    "alone": _when(lambda node: node.own_name, "did not run outside of the launch file"),
    "asked": _when(Node.has_ended, "was not seen to end"),
}
