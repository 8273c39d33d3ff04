# SPDX-License-Identifier: BSD-3-Clause
"""A package under check that no contract describes: its executables are the nodes."""

from __future__ import annotations

import codecs
import functools
import pathlib
import re
import stat
from concurrent.futures import Future
from typing import Any

from mrp_check.build import compiler
from mrp_check.code import executables, uses
from mrp_check.contract.finding import Finding
from mrp_check.contract.spec import Spec
from mrp_check.package import launch as launching
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package
from mrp_check.run import observing, unasked
from mrp_check.run.case import Case

# A folder that catkin_package() names.
_INCLUDED = r"(?m)^[^#\n]*\bINCLUDE_DIRS\s+(\w+)\b(?!/)"
_MOST = 12  # launch files that are looked at


class AnyCase(Case):
    """A package under check without a contract. `launch` is all launch files together.

    enough: messages of each publisher that are waited for
    """

    enough = 3
    stands_in = True

    def __init__(self, package: Package, *given: Any) -> None:
        super().__init__(package, *given)
        # Where a package wants no warnings, CMake's files say which.
        if not package.first_match(package.of_kind("cmake"), "-Werror"):
            self.compiler_flags = compiler.DOUBTING
        # CMake stops where one is missing, and a rule says so: the rest is to be checked, too.
        for file in {"CMakeLists.txt"} & {*package.files}:
            for name in re.findall(_INCLUDED, package.text(file)):
                if not (self.package_folder / name).exists():
                    (self.package_folder / name).mkdir()

    def _copy(self, path: str) -> bool:
        copied, package = super()._copy(path), self.package
        is_python = package.kind(path) == "python" and package.shebang(path)
        if is_python and executables.is_script(package, path):
            _make_startable(self.package_folder / path)
        return copied

    @functools.cached_property
    def spec(self) -> Spec:
        return executables.spec(self.package, self.model)

    @functools.cached_property
    def launch_file(self) -> tuple[str | None, list[Finding]]:
        return None, [f for file in self._files for f in launching.problems(self.package, file)]

    @property
    def _files(self) -> list[str]:
        files = [file for file in self.package.of_kind("launch") if not uses.is_test(file)]
        return files[:_MOST]

    @functools.cached_property
    def _loading_all(self) -> Future[list[Launch]]:
        _ = self.manifest  # what stands in the copy is read
        files = [file for file in self._files if not launching.problems(self.package, file)]
        return self.submit(lambda: [launching.load(self, file) for file in files])

    @functools.cached_property
    def launches(self) -> list[Launch]:
        return self._loading_all.result()

    @functools.cached_property
    def launch(self) -> Launch | None:
        loaded = [launch for launch in self.launches if not launch.error]
        if not loaded:
            return None
        return Launch(
            "",
            nodes=[node for launch in loaded for node in launch.nodes],
            files=list(dict.fromkeys(file for launch in loaded for file in launch.files)),
            params={name: v for launch in loaded for name, v in launch.params.items()},
            file=loaded[0].file,
        )

    @functools.cached_property
    def observed(self) -> observing.Observed:
        return unasked.observe(self.sessions, self.spec, self.launches, self.facts, self.enough)


def _make_startable(path: pathlib.Path) -> None:
    """Mend in the copy what keeps Linux from starting a script: the rules look at the original,
    and so the rest of it can be checked, too."""
    first, end, rest = path.read_bytes().partition(b"\n")
    first = first[len(codecs.BOM_UTF8) :] if first.startswith(codecs.BOM_UTF8) else first
    if b"python" in first:
        path.write_bytes(b"#!/usr/bin/python3" + end + rest)
    path.chmod(path.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)
