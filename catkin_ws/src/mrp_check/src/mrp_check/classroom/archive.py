# SPDX-License-Identifier: BSD-3-Clause
"""What is packed: a zip, a tar or a git bundle, unpacked with suspicion.

Nothing that an archive says about itself is believed: what comes out is counted while it comes.
Only what may belong to a package is written, so large files beside it are not. Debian 12's tarfile
has no filters: what is refused here is so for all formats.
"""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
import lzma
import pathlib
import posixpath
import re
import shutil
import struct
import tarfile
import zipfile
import zlib
from typing import Any, Callable, Iterable, Iterator

from mrp_check.classroom import formats
from mrp_check.classroom.formats import FILE, LINK, LONGEST, MEGABYTE, OTHER, SAME, Entry
from mrp_check.contract.errors import PackageError
from mrp_check.contract.names import last_part
from mrp_check.package.package import BUILT, MAX_BYTES, is_of_tools

_MOST_PACKED = 2000 * MEGABYTE  # of one archive
_MOST_UNPACKED = 4 * MAX_BYTES  # of one submission
_FREE, _MOST_RATIO = 20 * MEGABYTE, 100  # from so many bytes on, not more than so many times
_MOST_ENTRIES = 100_000
_DEEPEST = 60  # folders in a path
_CHUNK = 4096  # of one so long, zipfile may make 90 MB at once

_NAMES = re.compile(
    r"\.(zip|tar|tgz|tbz2?|txz|(tar\.)?(gz|bz2|xz|zst)|bundle|7z|rar)$", re.IGNORECASE
)
# What a library raises about an archive that is damaged or hostile.
_BROKEN = (
    *(zipfile.BadZipFile, tarfile.TarError, lzma.LZMAError, zlib.error, struct.error, EOFError),
    *(OSError, RuntimeError, ValueError, LookupError, OverflowError, MemoryError),
)


@dataclasses.dataclass
class Budget:
    """What the unpacking of one submission has written, with the archives in its archives."""

    written: int = 0


def has_its_name(name: str) -> bool:
    """Return whether a file is called like an archive, also one that can't be read here."""
    return bool(_NAMES.search(name)) and not is_of_tools(name)


def without_suffix(name: str) -> str:
    """Return the name of an archive without what says its format."""
    return _NAMES.sub("", name)


def unpack(path: pathlib.Path, folder: pathlib.Path, budget: Budget) -> None:
    """Unpack the packages of an archive; if it has none, the archives in it. Raises PackageError.

    folder: a new one
    """
    folder.mkdir(parents=True)
    try:
        with contextlib.ExitStack() as stack:
            archive = formats.opened(path, stack)
            entries = {entry.path: entry for entry in _accepted(path.name, archive.entries())}
            _Unpacking(path, archive, folder, budget).write(_wanted(entries))
    except _BROKEN as error:
        said = str(error) or type(error).__name__
        raise PackageError(f"{path.name} can't be unpacked: {said}. Pack it again.") from None


def refuse_huge(path: pathlib.Path) -> None:
    """Raises PackageError if an archive is too large to be read at all."""
    size = path.stat().st_size
    if size > _MOST_PACKED:
        raise PackageError(
            f"{path.name} has {size // MEGABYTE} MB: more than {_MOST_PACKED // MEGABYTE} MB"
            " aren't read. Hand in only the package."
        )


# Why an entry is refused, wherever it is in the archive.
_REFUSED: tuple[tuple[Callable[[Entry], bool], str], ...] = (
    (lambda one: bool(re.match("/|[A-Za-z]:/", one.path)), "its path is absolute"),
    (lambda one: ".." in one.path.split("/"), "its path leads out of the archive"),
    (lambda one: one.kind == OTHER, "it is a device or a pipe"),
    (
        lambda one: len(one.path) > LONGEST or one.path.count("/") > _DEEPEST,
        "its path is too long",
    ),
)


def _accepted(name: str, entries: Iterable[Entry]) -> Iterator[Entry]:
    """Yield the entries, each with its plain path. Raises PackageError at one that is refused."""
    for number, entry in enumerate(entries, 1):
        if number > _MOST_ENTRIES:
            raise PackageError(
                f"{name} is refused: it has more than {_MOST_ENTRIES} entries."
                " Hand in only the package."
            )
        for is_so, why in _REFUSED:
            if is_so(entry):
                raise _refusal(name, entry, why)
        entry.path = posixpath.normpath(entry.path)
        yield entry


def _refusal(name: str, entry: Entry, why: str) -> PackageError:
    path = entry.path if len(entry.path) < 200 else entry.path[:200] + "..."
    return PackageError(f"{name} is refused for its entry {path}: {why}. Pack it without that.")


def _wanted(entries: dict[str, Entry]) -> list[Entry]:
    """Return the entries in packages, without what was built; if there are none, the archives."""
    files = [path for path, entry in entries.items() if entry.kind == FILE]
    manifests = {posixpath.dirname(path) for path in files if last_part(path) == "package.xml"}
    built = {posixpath.dirname(path) for path in files if last_part(path) in BUILT}
    built -= manifests | {""}
    sources = [path for path in entries if not (_above(path) & built or _is_of_tools(path))]
    roots = manifests & {posixpath.dirname(path) for path in sources}
    if not roots:
        return [entries[path] for path in files if has_its_name(last_part(path))]
    return [entries[path] for path in sources if _above(path) & roots]


def _above(path: str) -> set[str]:
    """Return the folders that a path is in."""
    return {"", *itertools.accumulate(path.split("/")[:-1], lambda one, two: f"{one}/{two}")}


def _is_of_tools(path: str) -> bool:
    return any(map(is_of_tools, path.split("/")))


class _Unpacking:
    """Writes entries into a folder. Links come last: so nothing is written through one."""

    def __init__(
        self, path: pathlib.Path, archive: Any, folder: pathlib.Path, budget: Budget
    ) -> None:
        self.path, self.archive, self.budget = path, archive, budget
        self.folder = folder.resolve()
        self._packed, self._written = path.stat().st_size, 0

    def write(self, entries: list[Entry]) -> None:
        makers = {FILE: self._file, SAME: self._same, LINK: self._link}
        for kind, make in makers.items():
            for entry in (one for one in entries if one.kind == kind):
                target = self.folder / entry.path
                if target.parent.resolve() != target.parent:
                    raise _refusal(self.path.name, entry, "it lies behind a link")
                target.parent.mkdir(parents=True, exist_ok=True)
                make(entry, target)

    def _file(self, entry: Entry, target: pathlib.Path) -> None:
        with open(target, "wb") as file:
            if entry.size > MAX_BYTES:
                file.truncate(MAX_BYTES + 1)  # Package leaves it out, and says so
                return
            with self.archive.open(entry.source) as packed:
                for chunk in iter(lambda: packed.read(_CHUNK), b""):
                    self._take(entry, len(chunk))
                    file.write(chunk)
        if entry.executable is None:
            with open(target, "rb") as file:
                entry.executable = file.read(2) == b"#!"
        target.chmod(0o755 if entry.executable else 0o644)

    def _take(self, entry: Entry, size: int) -> None:
        self._written += size
        self.budget.written += size
        if self.budget.written > _MOST_UNPACKED:
            why = f"what is unpacked is more than {_MOST_UNPACKED // MEGABYTE} MB by then"
            raise _refusal(self.path.name, entry, why)
        if self._written > max(_FREE, _MOST_RATIO * self._packed):
            why = f"it unpacks to more than {_MOST_RATIO} times its size, as a zip bomb does"
            raise _refusal(self.path.name, entry, why)

    def _same(self, entry: Entry, target: pathlib.Path) -> None:
        source = self.folder / posixpath.normpath(entry.target)
        inside = not entry.target.startswith("/") and ".." not in entry.target.split("/")
        if not inside or not source.is_file():
            raise _refusal(self.path.name, entry, "it is a link to a file outside the package")
        self._take(entry, source.stat().st_size)
        shutil.copy(source, target)

    def _link(self, entry: Entry, target: pathlib.Path) -> None:
        to = posixpath.normpath(posixpath.join(posixpath.dirname(entry.path), entry.target))
        if to.startswith(("/", "../")) or to == "..":
            raise _refusal(self.path.name, entry, f"it is a link out of it, to {entry.target}")
        target.symlink_to(entry.target)
