# SPDX-License-Identifier: BSD-3-Clause
"""One package under check: its copy, and what is known of it, each worked out when first asked."""

from __future__ import annotations

import functools
import pathlib
from concurrent.futures import Future
from typing import Callable

from catkin_pkg.package import Package as Manifest

from mrp_check.build.catkin import Catkin, Step
from mrp_check.code import reading, source_node, uses
from mrp_check.code.cpp_read import CppReader
from mrp_check.code.facts import Facts
from mrp_check.confined import cpp_headers
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import Finding
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec
from mrp_check.package import launch as launching
from mrp_check.package import manifest
from mrp_check.package.cmake import Model
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package
from mrp_check.package.workspace import Workspace
from mrp_check.run import observing
from mrp_check.run.node import Node
from mrp_check.run.sessions import Sessions
from mrp_check.run.source_lines import Places


class Case(Workspace):
    """One package under check.

    folder: a scratch folder, deleted in the end
    catkin: configures and builds the copy
    """

    def __init__(
        self,
        package: Package,
        spec: Spec | None,
        folder: pathlib.Path,
        timeout: float,
        progress: Callable[[str], None],
    ) -> None:
        super().__init__(package, folder, timeout, progress)
        self._spec = spec
        self.catkin = Catkin(self)
        self.sessions = Sessions(self)

    def close(self) -> None:
        self.sessions.end()
        super().close()

    @functools.cached_property
    def spec(self) -> Spec:
        assert self._spec
        return self._spec

    @functools.cached_property
    def headers(self) -> Future[pathlib.Path]:
        """The file of ROS's headers; it is read in the background from the first call on."""
        return self.submit(cpp_headers.make, self.given / cpp_headers.NAME)

    @functools.cached_property
    def manifest(self) -> tuple[Manifest | None, Finding | None]:
        """catkin_pkg's Package, or None if it cannot read package.xml, and the Finding about it.

        In the copy a valid one takes its place, so that what comes after can be checked."""
        parsed, problem = manifest.parse(self.package)
        if problem:
            manifest.replace(self)
        return parsed, problem

    @functools.cached_property
    def launch_file(self) -> tuple[str | None, list[Finding]]:
        """The path of the launch file, or None; and the Findings that say why it cannot be read."""
        return launching.readable(self.package, self.spec)

    @functools.cached_property
    def _loading(self) -> Future[Launch] | None:
        _ = self.manifest  # what stands in the copy is read
        file, problems = self.launch_file
        return self.submit(launching.load_twice, self, file) if file and not problems else None

    @functools.cached_property
    def launch(self) -> Launch | None:
        """What roslaunch makes of the launch file; None if it cannot."""
        return self._loading.result() if self._loading else None

    @functools.cached_property
    def launches(self) -> list[Launch]:
        """The same of each launch file that is looked at."""
        return [self.launch] if self.launch else []

    @functools.cached_property
    def model(self) -> Model:
        """What CMakeLists.txt says. What comes next begins."""
        _ = self._loading
        model = self.catkin.model
        self.catkin.start_building()
        if self.sessions.have_begun:
            _ = self.environment
        return model

    @functools.cached_property
    def started(self) -> dict[str, Started]:
        """Python file -> the node of the launch file that it is."""
        nodes = self.launch.nodes if self.launch else []
        return {
            path: node
            for node in nodes
            for path in self.package.of_kind("python")
            if node.package == self.package.name and last_part(path) == node.type
        }

    @functools.cached_property
    def facts(self) -> Facts:
        """What the sources say."""
        if self.package.of_kind(*uses.DEFINITIONS):
            self.catkin.wait_until_built()  # before, there are no headers of its messages
        reader = CppReader(self, self.catkin.compile_commands(), lambda: self.headers)
        return reading.read(reader, self.spec, self.model, self.launch)

    @functools.cached_property
    def coded(self) -> list[source_node.SourceNode]:
        """The nodes of the spec as their sources tell them."""
        return source_node.nodes(self.package, self.spec, self.model, self.launch, self.facts)

    @functools.cached_property
    def built(self) -> Step | None:
        """What came of building; None if CMake failed."""
        return self.catkin.built if self.catkin.configured.ok else None

    @functools.cached_property
    def observed(self) -> observing.Observed:
        """What was seen when the nodes ran."""
        return observing.observe(self.sessions, self.spec, self.launch, self.facts)

    @functools.cached_property
    def places(self) -> Places:
        return Places(self, self.facts, self.observed)

    @functools.cached_property
    def nodes(self) -> dict[str, Node]:
        """What was seen of each node of the spec, by its name."""
        return {name: Node(node, self.spec, self.places) for name, node in self.spec.nodes.items()}
