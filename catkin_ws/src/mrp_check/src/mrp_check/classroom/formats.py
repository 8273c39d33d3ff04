# SPDX-License-Identifier: BSD-3-Clause
"""The formats in which a package may be packed: what each archive has, entry by entry.

What asks for much memory, or unpacks to too much, is refused here; which entries may be written at
all, archive.py says.
"""

from __future__ import annotations

import bz2
import contextlib
import dataclasses
import gzip
import io
import lzma
import pathlib
import re
import shutil
import stat
import tarfile
import tempfile
import zipfile
from typing import IO, Any, Callable, Iterator

from mrp_check.contract.errors import PackageError
from mrp_check.sandbox import confine

MEGABYTE = 10**6
LONGEST = 3000  # letters of a path
_MOST_PASSED = 1000 * MEGABYTE  # of a compressed tar: what lies before a file must be read, too
_MOST_AT_ONCE = 8 * MEGABYTE  # such as a zip's list of its files

FILE, FOLDER, LINK, SAME, OTHER = "file", "folder", "link", "same", "other"


@dataclasses.dataclass
class Entry:
    """One entry of an archive.

    kind: SAME is another name of the file `target`; OTHER is a device or a pipe
    executable: None if the archive does not know
    source: what the library calls it
    """

    path: str
    kind: str
    size: int
    executable: bool | None
    target: str
    source: Any


class Plain(io.BufferedReader):
    """A file that is read in small parts: what asks for more at once is a hostile header."""

    def __init__(self, path: pathlib.Path, raw: Any, most: float = float("inf")) -> None:
        super().__init__(raw)
        self.path, self._most = path, most

    def read(self, size: int | None = -1) -> bytes:
        if size and size > _MOST_AT_ONCE:
            raise PackageError(f"{self.path.name} is refused: its list of files is too long.")
        data = super().read(size)
        self._allow(self.tell())
        return data

    def seek(self, offset: int, whence: int = 0) -> int:
        self._allow(offset)
        return super().seek(offset, whence)

    def _allow(self, offset: int) -> None:
        if offset > self._most:
            raise PackageError(
                f"{self.path.name} is refused: it unpacks to more than"
                f" {_MOST_PASSED // MEGABYTE} MB. Hand in only the package."
            )


# What reads a format. What it has opened is closed by the stack.
Reader = Callable[[Plain, contextlib.ExitStack], Any]


class _Zip:
    def __init__(self, file: Plain, stack: contextlib.ExitStack) -> None:
        self._zip = stack.enter_context(zipfile.ZipFile(file))
        # git, which writes its commit as the comment, gives modes to what is executable alone.
        self._has_modes = bool(re.fullmatch(rb"[0-9a-f]{40}", self._zip.comment)) or any(
            info.create_system == _UNIX for info in self._zip.infolist()
        )

    def entries(self) -> Iterator[Entry]:
        for info in self._zip.infolist():
            mode = info.external_attr >> 16 if info.create_system == _UNIX else 0
            path, target = _zip_name(info), ""
            kind = FOLDER if path.endswith("/") else _kind(mode)
            if kind == LINK:
                with self.open(info) as file:
                    target = file.read(LONGEST).decode("utf-8", "replace")
            executable = bool(mode & stat.S_IXUSR) if self._has_modes else None
            yield Entry(path, kind, info.file_size, executable, target, info)

    def open(self, source: zipfile.ZipInfo) -> IO[bytes]:
        return self._zip.open(source)


_UNIX = 3  # in a zip, the system that wrote an entry


def _zip_name(info: zipfile.ZipInfo) -> str:
    """Return the name. Finder writes UTF-8 without saying so, and .NET writes backslashes."""
    name = info.filename
    if not info.flag_bits & 0x800:
        try:
            name = name.encode("cp437").decode("utf-8")
        except UnicodeError:
            pass  # it is as Windows' Explorer writes it
    return name.replace("\\", "/")


def _kind(mode: int) -> str:
    known = {0: FILE, stat.S_IFREG: FILE, stat.S_IFDIR: FOLDER, stat.S_IFLNK: LINK}
    return known.get(stat.S_IFMT(mode), OTHER)


class _Tar:
    def __init__(self, file: Plain, stack: contextlib.ExitStack) -> None:
        self._tar = stack.enter_context(tarfile.open(fileobj=file, mode="r:"))

    def entries(self) -> Iterator[Entry]:
        for info in self._tar:
            types = {info.isreg(): FILE, info.isdir(): FOLDER}
            types.update({info.issym(): LINK, info.islnk(): SAME})
            kind, executable = types.get(True, OTHER), bool(info.mode & stat.S_IXUSR)
            yield Entry(info.name, kind, info.size, executable, info.linkname, info)

    def open(self, source: tarfile.TarInfo) -> IO[bytes]:
        file = self._tar.extractfile(source)
        assert file is not None
        return file


def _packed_tar(opened: Callable[[IO[bytes]], Any]) -> Reader:
    """Return what reads a tar that is compressed so."""

    def read(file: Plain, stack: contextlib.ExitStack) -> _Tar:
        plain = Plain(file.path, opened(file), _MOST_PASSED)
        return _Tar(stack.enter_context(plain), stack)

    return read


# Which commit: of a bundle without HEAD, the latest one.
_GIT = """git clone --quiet --bare given repository && cd repository &&
commit=$(git rev-parse --quiet --verify HEAD ||
  git for-each-ref --count=1 --sort=-committerdate --format="%(objectname)") &&
git archive -o ../files.tar "$commit"
"""


def _bundle(file: Plain, stack: contextlib.ExitStack) -> _Tar:
    """Have git make a tar of it, confined: git reads what a stranger wrote."""
    if not shutil.which("git"):
        raise PackageError(f"{file.path.name} is a git bundle: install git to read it.")
    folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="mrp_check_")))
    shutil.copyfile(file.path, folder / "given")
    limits = confine.Limits(time=60, file_size=_MOST_PASSED, disk=3 * _MOST_PASSED)
    try:
        done = confine.run(["sh", "-c", _GIT], folder, limits)
    except confine.ConfineError as error:
        raise PackageError(f"{file.path.name} can't be unpacked: {error}.") from None
    if done.code != 0:
        said = done.limit_text(limits) or (done.errors.strip().splitlines() or ["nothing"])[-1]
        raise PackageError(
            f"{file.path.name} is a git bundle, but git can't read it: {said}. Make it with: git"
            " bundle create NAME.bundle HEAD"
        )
    tar = Plain(file.path, open(folder / "files.tar", "rb", buffering=0))
    return _Tar(stack.enter_context(tar), stack)


# Where a format's mark is, what it is called, and what reads it.
_FORMATS: tuple[tuple[bytes, int, str, Reader | None], ...] = (
    (b"PK\x03\x04", 0, "zip", _Zip),
    (b"PK\x05\x06", 0, "zip", _Zip),
    (b"ustar", 257, "tar", _Tar),
    (b"\x1f\x8b", 0, "tar.gz", _packed_tar(gzip.open)),
    (b"BZh", 0, "tar.bz2", _packed_tar(bz2.open)),
    (b"\xfd7zXZ\0", 0, "tar.xz", _packed_tar(lzma.open)),
    (b"# v2 git bundle", 0, "git bundle", _bundle),
    (b"# v3 git bundle", 0, "git bundle", _bundle),
    (b"7z\xbc\xaf'\x1c", 0, "a 7-Zip archive", None),
    (b"Rar!", 0, "a RAR archive", None),
    (b"\x28\xb5\x2f\xfd", 0, "a Zstandard archive", None),
    (b"%PDF", 0, "a PDF file", None),
)


def opened(path: pathlib.Path, stack: contextlib.ExitStack) -> Any:
    """Return an archive: what has entries(), and opens one of them. Raises PackageError."""
    file = stack.enter_context(Plain(path, open(path, "rb", buffering=0)))
    head = file.read(512)
    file.seek(0)
    for mark, place, name, reader in _FORMATS:
        if head[place : place + len(mark)] == mark:
            if reader:
                return reader(file, stack)
            raise PackageError(f"{path.name} is {name}: {_EXPECTED}.")
    what = "a single file, but not an archive that can be read" if head else "an empty file"
    raise PackageError(f"{path.name} is {what}: {_EXPECTED}.")


_EXPECTED = "expected the package's folder, or a zip, a tar, a tar.gz or a git bundle of it"
