# SPDX-License-Identifier: BSD-3-Clause
"""Report each cause once, and mark the findings that follow from it."""

from __future__ import annotations

from mrp_check.contract.finding import ERROR, NOTE, READ, SEEN, Finding

# With one of these, a node cannot run, or is the wrong node.
_FATAL = set(
    (
        "manifest package-name cmake targets scripts messages text launch-nodes"
        " python-syntax python-names node-start configure compile link"
    ).split()
)
_PACKAGE_WIDE = {"manifest", "package-name", "cmake", "configure"}
_OF_BUILDING = _PACKAGE_WIDE | {"launch-file", "dependencies", "messages", "targets", "scripts"}

# What a node does not do if it does not work.
_WORK = {"values", "rate", "wrap", "received", "console", "topic", "services", "examples"}

# cause -> what follows from it in the same node
_FOLLOWS = {
    "configure": {"compile", "link"},
    "compile": {"link"},
    "dependencies": {"configure", "compile", "link"},
    "manifest": {"configure", "dependencies", "compile", "link"},
    "package-name": {"configure", "launch-nodes"},
    "cmake": {"configure", "compile", "link", "targets", "launch-nodes", "messages"},
    "targets": {"configure", "link", "launch-nodes", "node-name"},
    "scripts": {"configure"},
    "messages": {"configure", "compile", "python-names", "wrap"},
    "text": {"python-syntax", "manifest", "launch-file", "compile"},
    "launch-nodes": {"node-name"},
    "launch-group": {"namespace", "topic", "console", "received", "starts"},
    "launch-output": {"console"},
    "spin": _WORK | {"starts", "exit"},
    "callbacks": _WORK | {"starts", "latch", "exit"},
    "lifetime": _WORK | {"starts", "exit"},
    "topic": _WORK | {"namespace", "type", "warnings"},
    "type": _WORK | {"warnings", "starts", "exit"},
    "queue": {"received", "starts", "console", "topic", "exit", "warnings"},
    "wrap": {"values"},
    # A name that is misspelt is not found where it is looked for.
    "python-names": {"node-start", "spin", "topic", "callbacks", "type"},
    "node-name": {"starts", "topic", "console"},
    "parameters": {"values", "received"},
    "examples": {"values", "received", "console"},
    "services": {"console", "starts", "exit"},
    "values": {"wrap", "rate"},
    "rate": {"wrap"},
    "received": {"console"},
    "namespace": {"received", "console", "warnings", "topic", "services", "examples"},
    # What was raised, or ended the node, as it ran: the rest is not what it would have been.
    "starts": _WORK | {"type", "exit", "leftovers"},
}

# What Python says of it when it fails is seen under the same id.
_OWN = {"python-names", "python-syntax"}

_LATER = {"run", "stop"}

# Files that are about the package as a whole.
_OF_ALL = ("CMakeLists.txt", ".cmake", ".xml", ".launch", ".msg")


def without_repeats(findings, facts=None, nodes=None, has_contract=True):
    """Return the findings without repetitions, with consequences marked.

    facts: a code.facts.Facts, which says which files a node is made of; or None
    nodes: name -> what was seen of a node of the spec, a run.node.Node; None if nothing has run
    has_contract: without one, what keeps Linux from starting a script is repaired in the copy that
        runs, and so nothing that ran follows from it
    """
    kept: list[Finding] = []
    seen: dict[tuple[object, ...], set[str | None]] = {}
    for finding in findings:
        # One line of package.xml or CMakeLists.txt may lack several things.
        lacks = finding.expected if finding.stage == "files" else ""
        what = (finding.id, finding.file, finding.line, finding.severity, lacks)
        of_nodes = seen.setdefault(what, set())
        # A rule about a source knows no node; one about the node that it makes says the same again.
        same = finding.node in of_nodes or finding.file and None in of_nodes
        if same and finding.severity != NOTE:
            for other in kept:  # what a source says was seen, too
                if finding.certainty == SEEN and (other.id, other.file, other.line) == what[:3]:
                    other.certainty = SEEN
            continue
        of_nodes.add(finding.node)
        kept.append(finding)
    for index, finding in enumerate(kept):
        if finding.consequence_of or finding.severity == NOTE:
            continue
        # Of several causes, the one that stands where it fails is not there by chance. What was
        # only read may do no harm, and what is not declared may be found all the same.
        ordered = sorted(
            enumerate(kept),
            key=lambda pair: (
                not _is_beside(pair[1], finding),
                not has_contract and pair[1].certainty == READ,
                pair[1].id == "dependencies",
            ),
        )
        for number, cause in ordered:
            if not has_contract and cause.id == "scripts" and finding.id != "configure":
                continue
            # A node may end before it gets to a name that doesn't exist.
            is_read = cause.id == "python-names" and cause.certainty != SEEN
            if not has_contract and is_read and finding.stage in _LATER and finding.id != cause.id:
                continue
            if cause is not finding and _causes(cause, finding, number < index, facts, nodes or {}):
                finding.consequence_of = cause.consequence_of or cause.id
                if finding.certainty == SEEN and cause.certainty == READ and cause.id not in _OWN:
                    cause.certainty = SEEN
                break
    return kept


def _is_beside(cause, finding):
    lines = cause.line, finding.line
    return cause.file == finding.file and None not in lines and abs(lines[0] - lines[1]) <= 1


def _is_of_another(cause, finding):
    """Return whether a source does not compile for another reason than this cause."""
    if finding.id != "compile" or cause.id not in {"dependencies", "messages", *_PACKAGE_WIDE}:
        return False
    if cause.id in _PACKAGE_WIDE:  # what is compiled, or read without a compiler, all the same
        return not finding.packages
    if cause.id == "messages":  # g++ stops at a header that is not made: this is behind it
        return cause.file == "CMakeLists.txt" and not finding.packages
    return not {*finding.packages} & {*cause.packages}


def _causes(cause, finding, earlier, facts, nodes):
    """Return whether a finding follows from a cause."""
    # What cannot be built cannot run, whatever keeps it from being built.
    passed_on = _PACKAGE_WIDE | {"compile", "link"}
    if cause.severity != ERROR or cause.consequence_of and cause.id not in passed_on:
        return False
    if _is_of_another(cause, finding):
        return False
    of_cause, of_finding = _nodes(cause, facts), _nodes(finding, facts)
    together = bool(of_cause & of_finding)
    if of_cause and of_finding and not together:
        return False
    follows = finding.id in _FOLLOWS.get(cause.id, ())
    if finding.stage not in _LATER:
        near = together or (cause.file, cause.line) == (finding.file, finding.line)
        return follows and cause.stage not in _LATER and (near or cause.id in _OF_BUILDING)
    if cause.stage in _LATER:
        # The stages run and stop tell of each node in the order of causes.
        return earlier and together and (follows or cause.id in _FATAL)
    # The same requirement, found broken twice: first in the source, then when it ran.
    if finding.id == cause.id:
        return True
    if (cause.id, finding.id) == ("messages", "exit"):
        return False  # it ran, and so they were there
    node = nodes.get(finding.node)
    if node is None or not node.is_up:
        return follows or cause.id in _FATAL
    if cause.id in _PACKAGE_WIDE or finding.id == "rate" and node.has_rate():
        return follows and together  # it ran all the same, and this was seen of it
    return follows or cause.id in _FATAL - {"messages"} and together  # they were there: it ran


def _nodes(finding, facts):
    """Return the nodes of the spec that a finding is about; none means that it may be any.

    A source that no node is made of stands for itself: it is about none of them."""
    if finding.node:
        return {finding.node}
    if facts is None or finding.file is None or finding.file.endswith(_OF_ALL):
        return set()
    return {name for name, files in facts.sources.items() if finding.file in files} or {
        finding.file
    }
