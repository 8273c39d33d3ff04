# SPDX-License-Identifier: BSD-3-Clause
"""The stage files: what can be said of a package before its code is looked into."""

from __future__ import annotations

from mrp_check.contract.requirements import Rule
from mrp_check.rules import (
    cmake_rules,
    dependencies,
    install,
    launch_rules,
    names,
    scripts,
    text,
)
from mrp_check.student import manifest


def _text(case):
    scripts_ = case.model.scripts
    relayed = {script.path for script in scripts_ if script.by == "catkin_install_python"}
    return text.findings(case.package, relayed)


def _name(case):
    readable = case.manifest[0] is not None
    return names.findings(case.package, case.model, case.launch) if readable else ()


def _manifest(case):
    parsed, problem = case.manifest
    return [problem] if problem else manifest.findings(case.package, parsed)


def _cmake(case):
    there = cmake_rules.FILE in case.package.files
    return cmake_rules.findings(case.package, case.model) if there else [cmake_rules.missing()]


def _launch(case):
    arguments = case.package, case.spec, case.model, case.launch
    return launch_rules.findings(*arguments) if case.launch else ()


def _install(case):
    if case.spec.install:
        yield from install.findings(
            case.package, case.spec, case.model, case.launch_file[0], case.started
        )


RULES = (
    Rule(("launch-file",), ("launch",), lambda case: case.launch_file[1]),
    Rule(("text",), ("model",), _text),
    Rule(("package-name",), ("manifest", "model", "launch"), _name),
    Rule(("manifest",), ("manifest",), _manifest),
    Rule(("cmake", "targets"), ("model",), _cmake),
    Rule(
        ("dependencies",),
        ("manifest", "model"),
        lambda case: dependencies.findings(case.package, case.spec, case.manifest[0], case.model),
    ),
    Rule(
        ("messages", "dependencies"),
        ("manifest", "model"),
        lambda case: cmake_rules.own_messages(
            case.package, case.spec, case.model, case.manifest[0]
        ),
    ),
    Rule(
        ("scripts",),
        ("model", "launch"),
        lambda case: scripts.findings(case.package, case.model, case.started),
    ),
    Rule(
        ("launch-file", "launch-nodes", "launch-group", "launch-output")
        + ("package-name", "targets", "topic"),
        ("model", "launch"),
        _launch,
    ),
    Rule(("install",), ("model", "launch"), _install),
)
