# SPDX-License-Identifier: BSD-3-Clause
"""The stage files: what can be said of a package before its code is looked into."""

from __future__ import annotations

from mrp_check.stages import launching
from mrp_check.stages.files import (
    cmake_rules,
    dependencies,
    install,
    launch_rules,
    manifest,
    names,
    scripts,
    text,
)


def findings(package, spec, workspace):
    """Yield a Finding for each thing that is wrong with the package's files as such."""
    parsed, problem = manifest.parse(package)
    if problem:
        yield problem
        manifest.replace(workspace, package.name)
    launch_file, problems = launch_rules.readable(package, spec)
    yield from problems
    if "CMakeLists.txt" not in package.files:
        yield cmake_rules.missing()
    catkin = workspace.catkin
    loading = None
    if launch_file and not problems:
        loading = catkin.submit(launching.load, package, workspace, launch_file)
    model = catkin.model
    catkin.start_building()
    workspace.launch = loading.result() if loading else None
    relayed = {script.path for script in model.scripts if script.by == "catkin_install_python"}
    yield from text.findings(package, relayed)
    if parsed is not None:
        yield from names.findings(package, model, workspace.launch)
        yield from manifest.findings(package, parsed)
    if "CMakeLists.txt" in package.files:
        yield from cmake_rules.findings(package, model)
    yield from dependencies.findings(package, spec, parsed, model)
    yield from cmake_rules.own_messages(package, spec, model, parsed)
    nodes = workspace.launch.nodes if workspace.launch else []
    started = {
        path: node
        for node in nodes
        for path in package.of_kind("python")
        if node.package == package.name and path.rsplit("/", 1)[-1] == node.type
    }
    yield from scripts.findings(package, model, started)
    if workspace.launch:
        yield from launch_rules.findings(package, spec, model, workspace.launch)
    if spec.install:
        yield from install.findings(package, spec, model, launch_file, started)
