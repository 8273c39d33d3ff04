# SPDX-License-Identifier: BSD-3-Clause
"""One package through all stages: used by the command, for a class and for the exercises."""

from __future__ import annotations

import dataclasses
import importlib
import pathlib
import shutil
import tempfile
import typing

from mrp_check import causes, confine, diff, requirements
from mrp_check.finding import ERROR, CannotCheck, Finding
from mrp_check.package import Package
from mrp_check.spec import Spec
from mrp_check.stages.catkin import Catkin, missing_tool
from mrp_check.stages.static import cpp_headers

MET, FINDINGS, UNCHECKED = "met", "findings", "unchecked"
BROKEN = "broken"


@dataclasses.dataclass
class Workspace:
    """Where one check works, and what its stages tell one another.

    folder: a scratch folder, deleted in the end; a catkin workspace
    package_folder: the copy of the package in it
    timeout: seconds that the whole check may take
    progress: called with a sentence that says what is being done
    catkin: a stages.catkin.Catkin, which configures and builds the copy
    headers: a future, whose result is the file of ROS's headers (stages.static.cpp_headers)
    built: whether catkin_make succeeded
    executables: name of each executable that there is after building -> its path
    launch: what roslaunch makes of the launch file, a stages.launching.Launch; None if it cannot
    facts: what the sources say, from stages.static (a facts.Facts); None before
    notes: anything that a stage wants to hand to a later one
    """

    folder: pathlib.Path
    package_folder: pathlib.Path
    timeout: float
    progress: typing.Callable[[str], None]
    catkin: typing.Any = None
    headers: typing.Any = None
    built: bool = False
    executables: dict[str, pathlib.Path] = dataclasses.field(default_factory=dict)
    launch: typing.Any = None
    facts: typing.Any = None
    notes: dict = dataclasses.field(default_factory=dict)


@dataclasses.dataclass
class Report:
    """What came of a check.

    verdict: MET, FINDINGS or UNCHECKED
    findings: in the order in which the stages found them
    requirements: id -> MET, BROKEN or UNCHECKED
    reason: why it is UNCHECKED, in one sentence
    """

    package: str
    spec: str
    verdict: str
    findings: list[Finding]
    requirements: dict[str, str]
    reason: str = ""


def check(
    path,
    spec: Spec,
    only=(),
    timeout: float = 600,
    progress: typing.Callable[[str], None] = lambda sentence: None,
    stages=None,
) -> Report:
    """Check one package.

    path: its folder
    only: ids of the only requirements to check; all if empty
    timeout: seconds that all of it may take
    stages: the only stages to run; all that are needed if None

    Raises PackageError if there is no package, CannotCheck if something else is missing.
    """
    package = Package(path)
    missing = missing_tool()
    if missing:
        raise CannotCheck(missing)
    needed = requirements.stages_for(only or requirements.REQUIREMENTS)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="mrp_check_"))
    try:
        workspace = _workspace(package, folder, timeout, progress)
        workspace.catkin = Catkin(workspace)
        chosen = needed if stages is None else [stage for stage in needed if stage in stages]
        findings, done = [], set()
        try:
            if "static" in chosen:
                workspace.headers = workspace.catkin.submit(cpp_headers.make, folder / "ros.pch")
            for stage in chosen:
                progress(f"stage {stage}")
                module = importlib.import_module(f"mrp_check.stages.{stage}")
                for finding in module.findings(package, spec, workspace):
                    finding.stage = finding.stage or stage
                    findings.append(finding)
                done.add(stage)
        finally:
            workspace.catkin.close()
    except confine.ConfineError as error:
        raise CannotCheck(f"A command could not be run confined: {error}.") from None
    finally:
        confine.remove(folder)
    findings = causes.told_once(findings, workspace.facts)
    for finding in findings:
        if finding.change and finding.file and finding.line:
            patch = diff.of_change(package, finding.file, finding.line, finding.change)
            finding.fix = "\n".join(part for part in (finding.fix, patch) if part)
    if only:
        findings = [finding for finding in findings if finding.id in only]
    return Report(
        package=package.name,
        spec=spec.title,
        verdict=FINDINGS if any(f.severity == ERROR for f in findings) else MET,
        findings=findings,
        requirements=_verdicts(findings, done, only),
    )


def _workspace(package, folder, timeout, progress):
    """Return a Workspace with a copy of the package, without what was built or is no plain file."""
    copy = folder / "src" / package.root.resolve().name
    for path in package.files:
        target = copy / path
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(package.root / path, target)
    return Workspace(folder, copy, timeout, progress)


def _verdicts(findings, done, only):
    """Return id -> MET, BROKEN or UNCHECKED."""
    broken = {f.id for f in findings if f.severity == ERROR and not f.consequence_of}
    unchecked = {f.id for f in findings if f.severity == ERROR and f.consequence_of} - broken
    verdicts = {}
    for id_, requirement in requirements.REQUIREMENTS.items():
        if only and id_ not in only:
            continue
        checked = requirement.stage in done and id_ not in unchecked
        verdicts[id_] = BROKEN if id_ in broken else MET if checked else UNCHECKED
    return verdicts
