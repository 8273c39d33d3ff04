# SPDX-License-Identifier: BSD-3-Clause
"""One cause is told once: what follows from it is marked as its consequence."""

from __future__ import annotations

from mrp_check.finding import ERROR, NOTE

# What keeps a node from running at all, or from being itself.
_FATAL = {
    "manifest",
    "package-name",
    "cmake",
    "targets",
    "scripts",
    "messages",
    "text",
    "launch-file",
    "launch-nodes",
    "python-syntax",
    "python-names",
    "node-start",
    "configure",
    "compile",
    "link",
}
_PACKAGE_WIDE = {"manifest", "package-name", "cmake", "launch-file", "configure"}

# What a node does not do if it does not work.
_WORK = {"values", "rate", "wrap", "received", "console", "topic"}

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
    "messages": {"configure", "compile", "python-names"},
    "text": {"python-syntax", "manifest", "launch-file", "compile"},
    "launch-nodes": {"node-name"},
    "launch-group": {"namespace", "topic", "console", "received", "starts"},
    "launch-output": {"console"},
    "spin": _WORK | {"starts", "exit"},
    "callbacks": _WORK | {"starts", "latch", "exit"},
    "lifetime": _WORK | {"starts", "exit"},
    "topic": {"values", "rate", "wrap", "received", "console", "namespace", "type", "warnings"},
    "type": _WORK | {"warnings", "starts", "exit"},
    "queue": {"received", "starts", "console", "topic", "exit", "warnings"},
    "wrap": {"wrap", "values"},
    # A name that is misspelt is not found where it is looked for.
    "python-names": {"node-start", "spin", "topic", "callbacks", "type"},
    "node-name": {"starts", "topic", "console"},
    "values": {"wrap", "rate"},
    "rate": {"wrap"},
    "received": {"console"},
    "namespace": {"received", "console", "warnings", "topic"},
    # What was raised, or ended the node, as it ran: the rest is not what it would have been.
    "starts": _WORK | {"type", "exit", "leftovers"},
}

# What one node fails to do, another one notices.
_NOTICED_BY_OTHERS = {"received", "console", "topic", "values", "rate"}

_LATER = {"run", "stop"}


def told_once(findings, facts=None):
    """Return the findings without repetitions, with consequences marked.

    facts: a stages.static.facts.Facts, which says which files a node is made of; or None
    """
    kept, seen = [], {}
    for finding in findings:
        what = (finding.id, finding.file, finding.line, finding.severity)
        nodes = seen.setdefault(what, set())
        # A rule about a source knows no node; one about the node that it makes says the same again.
        same = finding.node in nodes or finding.file and None in nodes
        if same and finding.severity != NOTE:
            continue
        nodes.add(finding.node)
        kept.append(finding)
    for index, finding in enumerate(kept):
        if finding.consequence_of or finding.severity == NOTE:
            continue
        for cause in kept:
            if cause is not finding and _causes(cause, finding, facts, kept.index(cause) < index):
                finding.consequence_of = cause.consequence_of or cause.id
                break
    return kept


def _causes(cause, finding, facts, earlier):
    """Return whether a finding follows from a cause."""
    # What cannot be built cannot run, whatever keeps it from being built.
    passed_on = _PACKAGE_WIDE | {"compile", "link"}
    if cause.severity != ERROR or cause.consequence_of and cause.id not in passed_on:
        return False
    if cause.stage in _LATER and finding.stage not in _LATER:
        return False
    same_place = (cause.file, cause.line) == (finding.file, finding.line)
    follows = finding.id in _FOLLOWS.get(cause.id, ())
    if finding.stage not in _LATER:
        if not follows:
            return False
        together = _nodes(cause, facts) & _nodes(finding, facts)
        return (
            same_place
            or cause.id in _PACKAGE_WIDE | {"dependencies", "messages", "targets", "scripts"}
            or bool(together)
        )
    # The same requirement, found broken twice: first in the source, then when it ran.
    if finding.id == cause.id and earlier and cause.stage not in _LATER:
        nodes = _nodes(cause, facts)
        return finding.node is None or not nodes or finding.node in nodes
    if cause.id in _PACKAGE_WIDE:
        return True
    if cause.stage in _LATER:
        # The stages run and stop tell of each node in the order of causes.
        same_node = finding.node is not None and finding.node == cause.node
        return earlier and same_node and (follows or cause.id in _FATAL)
    if cause.id not in _FATAL and not follows:
        return False
    if not _nodes(cause, facts) or finding.node is None or finding.node in _nodes(cause, facts):
        return True
    return finding.id in _NOTICED_BY_OTHERS and cause.id != "queue"


def _nodes(finding, facts):
    """Return the nodes of the spec that a finding is about; none means that it may be any."""
    if finding.node:
        return {finding.node}
    if facts is None or finding.file is None:
        return set()
    return {name for name, files in facts.sources.items() if finding.file in files}
