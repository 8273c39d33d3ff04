# SPDX-License-Identifier: BSD-3-Clause
"""Reads C++ sources by clang, confined."""

from __future__ import annotations

import pathlib
from concurrent.futures import Future
from typing import Callable, Mapping, Sequence

from mrp_check import sandbox
from mrp_check.confined import cpp_headers, crossing
from mrp_check.confined.places import Said
from mrp_check.contract.errors import CannotCheck
from mrp_check.package.workspace import Workspace
from mrp_check.sandbox import confine

_KEPT = 300  # characters of what the reader says when it fails


class CppReader:
    """Reads a package's C++ sources by clang, confined.

    commands: a source's path -> (folder, command) of its compiler, as far as CMake says that
    headers: returns the file of cpp_headers.make(), once there is one
    """

    def __init__(
        self,
        workspace: Workspace,
        commands: Mapping[str, tuple[str, list[str]]],
        headers: Callable[[], Future[pathlib.Path]],
    ) -> None:
        self.workspace, self.commands, self.headers = workspace, commands, headers

    def read(self, file: str) -> Said | None:
        """Return what a source says, or None if it cannot be read. Raises CannotCheck."""
        workspace, reader = self.workspace, str(sandbox.code() / "cpp_facts.py")
        given = str(workspace.package_folder), str(self.headers().result()), *self._unit(file)
        try:
            # One may include any other.
            of = workspace.package.of_kind("cpp", "header")
            done = workspace.run_once("/usr/bin/python3", reader, *given, of=of)
        except confine.ConfineError:
            return None
        try:
            return crossing.from_json(Said, done.output)
        except crossing.CrossingError:
            self._see_whose_fault(file, done)
            return None

    def _see_whose_fault(self, file: str, done: confine.Result) -> None:
        """Raise CannotCheck if it is not the source's fault that there is no answer."""
        if "No module named 'clang'" in done.errors:
            raise CannotCheck(
                "Python's module clang isn't installed: install Debian's package python3-clang"
                " (make deps)."
            )
        if done.ended_by == "time":
            raise CannotCheck(
                f"Reading {file} didn't end within {self.workspace.timeout:.0f} s: the machine is"
                " too busy; --timeout gives it more time."
            )
        if done.errors.startswith("Traceback") and not done.ended_by:
            raise CannotCheck(f"The C++ reader failed: {done.errors.strip()[-_KEPT:]}")

    def _unit(self, file: str) -> list[str]:
        """Return a source's path, and what clang needs to know to read it."""
        copy = self.workspace.package_folder
        source = str(copy / file)
        unknown = str(copy), ["c++", *self._defaults()]
        folder, command = self.commands.get(source, unknown)
        return [source, "-working-directory", folder, *_arguments(command, source)]

    def _defaults(self) -> list[str]:
        """Return arguments for a source that CMake could not say how to compile."""
        workspace = self.workspace
        own = workspace.package_folder / "include", workspace.folder / "devel" / "include"
        name = workspace.package.name.replace('"', "")
        folders = [*own, *cpp_headers.FOLDERS]
        return [f'-DROS_PACKAGE_NAME="{name}"', *(f"-I{folder}" for folder in folders)]


def _arguments(command: Sequence[str], source: str) -> list[str]:
    """Return what of a compiler's command line clang needs: without outputs and g++'s own flags."""
    kept, skip = [cpp_headers.STANDARD], False
    for word in command[1:]:
        if skip:
            skip = False
        elif word in ("-o", "-MF", "-MT", "-MQ"):
            skip = True
        elif word.startswith(("-I", "-D", "-U", "-std", "-isystem", "-include")) or not (
            word.startswith("-") or word == source
        ):
            kept.append(word)
    return [*kept, "-w", "-ferror-limit=50"]
