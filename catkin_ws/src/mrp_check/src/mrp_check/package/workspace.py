# SPDX-License-Identifier: BSD-3-Clause
"""A scratch workspace with a copy of a package, in which the package's programs run, confined.

Another check may have left it, with what it has built. If nothing has changed since then that CMake
reads, only the files that are different are copied, and only what needs them is made or read again.
"""

from __future__ import annotations

import concurrent.futures
import dataclasses
import filecmp
import functools
import hashlib
import json
import os
import pathlib
import re
import shutil
from typing import Callable, Mapping, Sequence, Tuple, TypeVar

from mrp_check.confined import variables, written
from mrp_check.contract.names import printable
from mrp_check.contract.resources import SHARES
from mrp_check.package.package import Package
from mrp_check.sandbox import confine

T = TypeVar("T")
Done = Tuple[bool, str, str]  # a catkin.Step

# Of this machine's own ROS, whatever workspace the user's shell has sourced.
NOETIC = pathlib.Path("/opt/ros/noetic/setup.bash")
# Prints the environment that these files make, as far as there are any.
_SOURCED = (
    'for file in "$@"; do [ ! -f "$file" ] || source "$file" -- || true; done; '
    "printf '\\0'; exec env -0"
)
_AT_ONCE = 4  # commands that run in the background at the same time
_BUILT = ("cpp", "header", "launch")  # kinds of files that CMake does not read
_NOT_MADE = {"python", "launch"}  # kinds that make does not read, but for a command of one's own
# What a CMakeLists.txt may have files written by that only it says.
_WRITES = re.compile(rb"add_custom_|configure_file|\bfile\s*\(", re.IGNORECASE)
_KNOWN = ".known"  # the ending of what run_once() keeps
_MOST_KNOWN = 100
_OF_RUNS = variables.FOLDERS.values()  # folders that the commands of one check write to


class Workspace:
    """A scratch workspace with a copy of a package, which can be built and run there.

    package: what is copied, without what was built or is no plain file
    folder: a catkin workspace, in which the package's own programs can write
    given: the folder of what the checker itself writes
    package_folder: the copy of the package
    configured: what came of CMake when the copy was configured, if it need not be done again
    made: the same of make, if there is nothing that it would make again
    compiles_again: whether a C++ file is different from that of the last check
    timeout: seconds that the whole check may take
    compiler_flags: what g++ is called with, in addition to the package's own flags
    stands_in: whether there are stubs of the packages that this machine has not
    static: whether only its messages are built, which its sources import
    progress: called with a sentence that says what is being done
    """

    compiler_flags = ""
    stands_in = False
    static = False

    def __init__(
        self,
        package: Package,
        folder: pathlib.Path,
        timeout: float,
        progress: Callable[[str], None],
    ) -> None:
        self.package, self.timeout, self.progress = package, timeout, progress
        self.folder, self.given = folder / "workspace", folder / "given"
        self.package_folder = self.folder / "src" / printable(package.root.resolve().name)
        self.given.mkdir(exist_ok=True)
        self._kept = self.given / "kept.json"
        cmake = [*package.of_kind("cmake"), *(p for p in package.files if p.endswith(".cmake"))]
        writes = any(_WRITES.search(package.bytes(path)) for path in cmake)
        # Before it is copied: it may change then.
        self._read_by_cmake = _digest(package, _BUILT)
        self._read_by_all = self._read_by_cmake if writes else _digest(package, (*_BUILT, "cmake"))
        for sibling in package.siblings:
            self._read_by_cmake += _digest(sibling, ())
            self._read_by_all += _digest(sibling, ())
        kept = self._take_kept()
        self.configured = kept and kept["configured"]
        if not self.configured and self.folder.exists():
            confine.remove(self.folder)
        self.folder.mkdir(mode=0o700, exist_ok=True)
        copied = [path for path in package.files if self._copy(path)]
        for sibling in package.siblings if not self.configured else ():
            folder = self.folder / "src" / printable(sibling.root.resolve().name)
            for path in sibling.files if not folder.exists() else ():
                (folder / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(sibling.root / path, folder / path)
        changed = {package.kind(path) for path in copied if self.configured}
        self.compiles_again = bool(changed & {"cpp", "header"})
        is_made = writes or not changed <= _NOT_MADE
        self.made = None if is_made else kept and kept["made"]
        self._pool = concurrent.futures.ThreadPoolExecutor(max_workers=_AT_ONCE)
        self._begun: dict[str, concurrent.futures.Future[confine.Result]] = {}

    def _copy(self, path: str) -> bool:
        """Copy a file of the package unless it is there as it is; return whether it was copied.

        It gets a new time, even where an old file is put back: so make builds it again.
        """
        source, target = self.package.root / path, self.package_folder / path
        if self.configured and target.is_file() and filecmp.cmp(source, target, shallow=False):
            return False
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        shutil.copy(source, target)
        return True

    def _take_kept(self) -> dict[str, Done | None] | None:
        """Return what keep() was given, if it fits the package. It holds once: what is built from
        now on may be cut short."""
        if not self._kept.exists():
            return None
        kept = json.loads(self._kept.read_text())
        self._kept.unlink()
        if kept["of"] != self._read_by_cmake or _has_link(self.package_folder):
            return None
        for folder in (*self.folder.glob("nodes_*"), *map(self.folder.joinpath, _OF_RUNS)):
            if folder.exists():
                confine.remove(folder)
        return kept

    def keep(self, configured: Done, made: Done | None) -> None:
        """Let the next check go on with what is built now; made: None if only the messages are."""
        kept = {"of": self._read_by_cmake, "configured": configured, "made": made}
        self._kept.write_text(json.dumps(kept))

    def close(self) -> None:
        """Wait for what still runs, and forget what was not asked for lately."""
        self._pool.shutdown(wait=True)
        known = sorted(self.given.glob(f"*{_KNOWN}"), key=lambda path: path.stat().st_mtime)
        for path in known[:-_MOST_KNOWN]:
            path.unlink()

    def submit(
        self, function: Callable[..., T], *arguments: object, **keywords: object
    ) -> concurrent.futures.Future[T]:
        """Run a function in the background; return its future."""
        return self._pool.submit(function, *arguments, **keywords)

    def tool(
        self, name: str, run: Callable[..., confine.Result], *command: str, **keywords: object
    ) -> concurrent.futures.Future[confine.Result]:
        """Run a tool in the background, if it doesn't run already; return its future.

        run: the function that is called with the command
        """
        if name not in self._begun:
            self._begun[name] = self.submit(run, *command, **keywords)
        return self._begun[name]

    def run(
        self,
        *command: str,
        seconds: float | None = None,
        readable: Sequence[pathlib.Path] = (),
        writable: Sequence[str] = (),
        env: Mapping[str, str] | None = None,
    ) -> confine.Result:
        """Run a command, confined, with this machine's own ROS. Raises ConfineError.

        seconds: that it may take, if not all of the timeout
        readable: folders that it may read, with the workspace
        writable: folders that it may write to, with the workspace
        env: variables that come on top
        """
        return confine.run(
            sourced(command),
            self.folder,
            confine.Limits(time=seconds or self.timeout),
            {**variables.environment(self.folder), **(env or {})},
            readable=[self.given, *readable],
            writable=writable,
        )

    def run_once(
        self,
        *command: str,
        of: Sequence[str],
        seconds: float | None = None,
        env: Mapping[str, str] | None = None,
    ) -> confine.Result:
        """As run(), unless an earlier check has run it on the same: then return what came of it.

        of: the files of the package that it reads, beside those that are no sources
        """
        # Of the copy: a file that is saved just now may be different.
        read = [(path, written.read(self.package_folder / path)) for path in of]
        made = sorted(os.walk(self.folder / "devel" / "include"))
        known = repr((command, env, self._read_by_all, read, made)).encode()
        path = self.given / (hashlib.sha256(known).hexdigest() + _KNOWN)
        if path.exists():
            path.touch()
            return confine.Result(**json.loads(path.read_text()))
        result = self.run(*command, seconds=seconds, env=env)
        if result.code == 0:
            path.write_text(json.dumps(dataclasses.asdict(result)))
        return result

    @functools.cached_property
    def environment(self) -> concurrent.futures.Future[dict[str, str]]:
        """That of the nodes: what setup.bash makes, as far as there is one. It is read in the
        background from the first call on."""
        return self.submit(self._environment)

    def _environment(self) -> dict[str, str]:
        setups = [str(NOETIC), str(self.folder / "devel" / "setup.bash")]
        made_by = self.package.of_kind("cmake")
        done = self.run_once("bash", "-c", _SOURCED, "bash", *setups, of=made_by)
        pairs = dict(entry.split("=", 1) for entry in done.output.split("\0") if "=" in entry)
        own = {variables.PACKAGES: self.ros_packages, variables.PYTHONPATH: ""}
        return {**own, **pairs, **variables.AT_ONCE}

    @property
    def ros_packages(self) -> str:
        """The ROS_PACKAGE_PATH of the copy and of this machine's own packages."""
        folders = [self.folder / "src", *map(pathlib.Path, SHARES)]
        return ":".join(str(folder) for folder in folders if folder.is_dir())


def _has_link(folder: pathlib.Path) -> bool:
    """Return whether a package has put a link into its copy: what is copied next would follow it to
    a file of the user's."""
    return any(path.is_symlink() for path in (folder, folder.parent, *folder.rglob("*")))


def _digest(package: Package, left_out: Sequence[str]) -> str:
    """Return a digest of the files' names, and of what CMake and catkin read of each file, but for
    files of these kinds."""
    read: list[object] = [str(package.root)]
    for path in package.files:
        kind = package.kind(path)
        if kind == "python" and not path.endswith("setup.py"):
            content: object = package.shebang(path)
        else:
            content = kind in left_out or package.bytes(path)
        read.append((path, package.is_executable(path), content))
    return hashlib.sha256(repr(read).encode()).hexdigest()


def search_path() -> str:
    return "/usr/bin:/bin:/usr/sbin:/sbin" + (":/opt/ros/noetic/bin" if NOETIC.exists() else "")


def sourced(command: Sequence[str]) -> list[str]:
    """Return a command that runs with this machine's own ROS."""
    if not NOETIC.exists():
        return list(command)
    return ["bash", "-c", 'source "$0" && exec "$@"', str(NOETIC), *command]
