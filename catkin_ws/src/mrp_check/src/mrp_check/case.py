# SPDX-License-Identifier: BSD-3-Clause
"""One package under check: its copy, and what is known of it, each worked out when first asked."""

from __future__ import annotations

import functools
import pathlib
import shutil

from mrp_check.building.catkin import Catkin
from mrp_check.confined import cpp_headers
from mrp_check.contract.spec import Spec
from mrp_check.running import observing
from mrp_check.running.node import Node
from mrp_check.running.places import Places
from mrp_check.sources import node as sources_node
from mrp_check.sources import reading
from mrp_check.student import launch as launching
from mrp_check.student import manifest
from mrp_check.student.package import Package


class Case:
    """One package under check.

    folder: a scratch folder, deleted in the end; a catkin workspace, in which the package's own
        programs can write
    given: the folder of what the checker itself writes
    package_folder: the copy of the package in it, without what was built or is no plain file
    timeout: seconds that the whole check may take
    progress: called with a sentence that says what is being done
    catkin: configures and builds the copy
    """

    def __init__(self, package: Package, spec: Spec, folder: pathlib.Path, timeout, progress):
        self.package, self.spec = package, spec
        self.folder, self.given = folder / "workspace", folder / "given"
        self.given.mkdir()
        self.folder.mkdir(mode=0o700)
        folder = self.folder
        self.timeout, self.progress = timeout, progress
        self.package_folder = folder / "src" / package.root.resolve().name
        for path in package.files:
            target = self.package_folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(package.root / path, target)
        self.catkin = Catkin(self)
        self.headers = None

    def read_headers(self):
        """Begin to read ROS's headers; `headers` is then a future, whose result is their file."""
        self.headers = self.catkin.submit(cpp_headers.make, self.given / "ros.pch")

    @functools.cached_property
    def manifest(self):
        """catkin_pkg's Package, or None if it cannot read package.xml, and the Finding about it.

        In the copy a valid one takes its place, so that what comes after can be checked."""
        parsed, problem = manifest.parse(self.package)
        if problem:
            manifest.replace(self, self.package.name)
        return parsed, problem

    @functools.cached_property
    def launch_file(self):
        """The path of the launch file, or None; and the Findings that say why it cannot be read."""
        return launching.readable(self.package, self.spec)

    @functools.cached_property
    def _loading(self):
        _ = self.manifest  # what stands in the copy is read
        file, problems = self.launch_file
        ready = file and not problems
        return self.catkin.submit(launching.load, self.package, self, file) if ready else None

    @functools.cached_property
    def launch(self):
        """What roslaunch makes of the launch file, a launching.Launch; None if it cannot."""
        return self._loading.result() if self._loading else None

    @functools.cached_property
    def model(self):
        """What CMakeLists.txt says, a cmake.Model. The launch file is loaded at the same time."""
        _ = self._loading
        model = self.catkin.model
        self.catkin.start_building()
        return model

    @functools.cached_property
    def started(self):
        """Python file -> the launching.Started node that it is."""
        nodes = self.launch.nodes if self.launch else []
        return {
            path: node
            for node in nodes
            for path in self.package.of_kind("python")
            if node.package == self.package.name and path.rsplit("/", 1)[-1] == node.type
        }

    @functools.cached_property
    def facts(self):
        """What the sources say, a facts.Facts."""
        return reading.read(self)

    @functools.cached_property
    def coded(self):
        """The nodes of the spec as their sources tell them, each a sources.node.Node."""
        return sources_node.nodes(self.package, self.spec, self.model, self.launch, self.facts)

    @functools.cached_property
    def built(self):
        """What came of building, a catkin.Step; None if CMake failed."""
        return self.catkin.built if self.catkin.configured.ok else None

    @functools.cached_property
    def observed(self):
        """What was seen when the nodes ran, an observing.Observed."""
        return observing.observe(self)

    @functools.cached_property
    def places(self):
        return Places(self)

    @functools.cached_property
    def nodes(self):
        """name -> Node: what was seen of each node of the spec."""
        return {name: Node(node, self) for name, node in self.spec.nodes.items()}
