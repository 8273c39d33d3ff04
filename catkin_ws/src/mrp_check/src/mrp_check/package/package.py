# SPDX-License-Identifier: BSD-3-Clause
"""A student's package as a folder that is only read."""

from __future__ import annotations

import ast
import codecs
import functools
import os
import pathlib
import re
import stat
import warnings
import xml.etree.ElementTree as ElementTree
from typing import Iterable, overload

from mrp_check.contract.errors import PackageError
from mrp_check.contract.names import last_part, nearest, perhaps, printable

# What is built or kept by tools, and no part of a package.
NOT_SOURCES = {".git", ".svn", ".vscode", ".idea", "__pycache__", ".pytest_cache", "CMakeFiles"}
NOT_SOURCES |= {"__MACOSX", ".DS_Store", "Thumbs.db", "desktop.ini"}
# A folder with one of these files is what catkin or CMake has built.
BUILT = {"CMakeCache.txt", ".catkin", ".built_by"}
# What an editor keeps of a file that it has changed.
BACKUP = re.compile(r"(~|#|\.(save|bak|orig|old|rej|sw[op]|tmp)(\.\d+)?)$")
MAX_FILES = 2000
MAX_BYTES = 50_000_000  # in all
MAX_TEXT = 1_000_000  # of one file that is read as text

KINDS = {
    ".py": "python",
    ".cpp": "cpp",
    ".cc": "cpp",
    ".cxx": "cpp",
    ".c++": "cpp",
    ".C": "cpp",
    ".h": "header",
    ".hpp": "header",
    ".hh": "header",
    ".hxx": "header",
    ".launch": "launch",
    ".msg": "message",
    ".srv": "service",
    ".action": "action",
    ".cmake": "cmake",
}


def is_of_tools(name: str) -> bool:
    """Return whether a file or folder is no part of a package, such as what Finder adds."""
    return name in NOT_SOURCES or name.startswith("._")


def declared_entity(data: bytes) -> int:
    """Return the line on which XML declares an entity, or 0: a few of them may stand for
    gigabytes, and no file of ROS needs one."""
    before, found, _ = data.replace(b"\0", b"").partition(b"<!ENTITY")
    return before.count(b"\n") + 1 if found else 0


class Package:
    """A folder with a package.xml.

    root: its path
    name: as package.xml says, or the folder's name if package.xml cannot be read
    files: the paths of its files, relative to root, with "/" between folders, in order
    left_out: the paths of files that are too large to be looked at
    siblings: the packages beside it that are built with it
    not_utf8: the same of those whose paths are not UTF-8: they are not looked at either

    Raises PackageError if there is no such folder, no package.xml, or too much of it.
    """

    def __init__(self, root: str | pathlib.Path) -> None:
        self.root = pathlib.Path(root).absolute()
        if not self.root.exists():
            beside = self.root.parent.glob("*/")
            near = nearest(self.root.name, [printable(path.name) for path in beside])
            raise PackageError(f"There's no folder {root}.{perhaps(near)}")
        if not self.root.is_dir():
            raise PackageError(f"{root} isn't a folder; expected the folder of a package.")
        self._bytes: dict[str, bytes] = {}
        self._trees: dict[str, ast.Module] = {}
        self._large: set[str] = set()
        self.left_out: list[str] = []
        self.not_utf8: list[str] = []
        self.siblings: list[Package] = []
        self.files = self._list()
        self._known = {*self.files}
        if "package.xml" not in self.files:
            raise PackageError(self._no_manifest())

    def _list(self) -> list[str]:
        sizes: dict[str, int] = {}
        total = 0
        for folder, folders, names in os.walk(self.root):
            if BUILT.intersection(names) and folder != str(self.root):
                folders.clear()
                continue
            folders[:] = sorted(name for name in folders if not is_of_tools(name))
            for name in sorted(name for name in names if not is_of_tools(name)):
                path = pathlib.Path(folder) / name
                # What is no regular file (a pipe, a link out of the folder) is never opened.
                if not self._is_inside(path):
                    continue
                known, size = path.relative_to(self.root).as_posix(), path.stat().st_size
                if printable(known) != known:
                    self.not_utf8.append(known)
                    continue
                if size > MAX_BYTES:
                    self.left_out.append(known)
                    continue
                if size > MAX_TEXT:
                    self._large.add(known)
                sizes[known] = size
                total += size
                if len(sizes) > MAX_FILES or total > MAX_BYTES:
                    raise PackageError(self._too_much(sizes))
        return list(sizes)

    def _too_much(self, sizes: dict[str, int]) -> str:
        largest = max(sizes, key=lambda path: sizes[path])
        return (
            f"{self.root} has more than {MAX_FILES} files or {MAX_BYTES // 10**6} MB, such as"
            f" {largest}: expected the folder of one package, without what was built."
        )

    def _is_inside(self, path: pathlib.Path) -> bool:
        try:
            real = path.resolve(strict=True)
            return self.root.resolve() in real.parents and stat.S_ISREG(real.stat().st_mode)
        except (OSError, RuntimeError):
            return False

    def _no_manifest(self) -> str:
        below = sorted(path for path in self.files if path.endswith("/package.xml"))
        text = f"{self.root} has no package.xml: expected the folder of a catkin package."
        if below:
            folders = [str(self.root / path[: -len("/package.xml")]) for path in below[:3]]
            text += f" Did you mean {' or '.join(folders)}?"
        return text

    def bytes(self, path: str) -> bytes:
        """Return a file's bytes, cut at MAX_TEXT; none of a file that is not the package's."""
        if path not in self._bytes and path not in self._known:
            return b""
        if path not in self._bytes:
            with open(self.root / path, "rb") as file:
                self._bytes[path] = file.read(MAX_TEXT)
        return self._bytes[path]

    def is_cut(self, path: str | None) -> bool:
        """Return whether this is a source of which only the beginning is read."""
        return path in self._large and self.kind(path) != "other"

    def text(self, path: str) -> str:
        """Return a file's text. What is no UTF-8 is replaced; line ends become newlines."""
        data = self.bytes(path)
        if data.startswith(codecs.BOM_UTF8):
            data = data[len(codecs.BOM_UTF8) :]
        return data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")

    def lines(self, path: str) -> list[str]:
        """Return a file's lines, without their ends."""
        return self.text(path).split("\n")

    def line(self, path: str, number: int) -> str:
        """Return what stands in a line of a file, the first of which is 1."""
        return self.lines(path)[number - 1].strip()

    def tree(self, path: str) -> ast.Module:
        """Return the syntax tree of a Python file: an empty one if Python cannot read it."""
        if path not in self._trees:
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    self._trees[path] = ast.parse(self.text(path))
            except (SyntaxError, ValueError, RecursionError, MemoryError):
                self._trees[path] = ast.Module(body=[], type_ignores=[])
        return self._trees[path]

    def kind(self, path: str) -> str:
        """Return python, cpp, header, launch, message, service, action, cmake, or other."""
        name = last_part(path)
        if name == "CMakeLists.txt":
            return "cmake"
        if BACKUP.search(name):
            return "other"
        kind = KINDS.get(pathlib.PurePosixPath(path).suffix)
        if kind is None and "python" in (self.shebang(path) or ""):
            return "python"
        if kind is None and path.endswith((".launch.xml", "_launch.xml")):
            return "launch"
        return kind or "other"

    def of_kind(self, *kinds: str) -> list[str]:
        """Return the paths of these kinds."""
        return [path for path in self.files if self.kind(path) in kinds]

    def shebang(self, path: str) -> str | None:
        """Return the first line if it begins with #! (whatever its end), or None."""
        first = self.bytes(path)[:200].split(b"\n")[0]
        return first.decode("utf-8", "replace") if first.startswith(b"#!") else None

    def is_executable(self, path: str) -> bool:
        """Return whether the file's owner may execute it."""
        return bool((self.root / path).stat().st_mode & stat.S_IXUSR)

    @overload
    def find_line(self, path: str, text: str, default: int) -> int: ...

    @overload
    def find_line(self, path: str, text: str, default: int | None = None) -> int | None: ...

    def find_line(self, path: str, text: str, default: int | None = None) -> int | None:
        """Return the number of the first line that has `text`, or `default`."""
        for number, line in enumerate(self.lines(path), 1):
            if text in line:
                return number
        return default

    def first_match(self, files: Iterable[str], pattern: str) -> tuple[str, int] | None:
        """Return the place of the first line in which a pattern is found, or None."""
        for file in files:
            for number, text in enumerate(self.lines(file), 1):
                if re.search(pattern, text):
                    return file, number
        return None

    @functools.cached_property
    def manifest(self) -> ElementTree.Element | None:
        """The root element of package.xml, or None if it is no XML."""
        if declared_entity(self.bytes("package.xml")):
            return None
        try:
            return ElementTree.fromstring(self.bytes("package.xml"))
        except (ElementTree.ParseError, ValueError, LookupError):
            return None

    @functools.cached_property
    def name(self) -> str:
        element = self.manifest.find("name") if self.manifest is not None else None
        text = (element.text or "").strip() if element is not None else ""
        if self.manifest is None:
            # It is no XML; its name can be read all the same.
            found = re.search(r"<name>\s*(\w+)\s*</name>", self.text("package.xml"))
            text = found.group(1) if found else ""
        return text or printable(self.root.resolve().name)
