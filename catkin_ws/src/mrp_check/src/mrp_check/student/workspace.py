# SPDX-License-Identifier: BSD-3-Clause
"""A scratch workspace with a copy of a package, in which the package's programs run, confined."""

from __future__ import annotations

import concurrent.futures
import pathlib
import shutil
from typing import Callable, Mapping, Sequence, TypeVar

from mrp_check import confine
from mrp_check.confined import variables
from mrp_check.contract.resources import SHARES
from mrp_check.student.package import Package

T = TypeVar("T")

# Of this machine's own ROS, whatever workspace the user's shell has sourced.
NOETIC = pathlib.Path("/opt/ros/noetic/setup.bash")
_AT_ONCE = 3  # commands that run in the background at the same time


class Workspace:
    """See above.

    package: what is copied, without what was built or is no plain file
    folder: a catkin workspace, in which the package's own programs can write
    given: the folder of what the checker itself writes
    package_folder: the copy of the package
    timeout: seconds that the whole check may take
    progress: called with a sentence that says what is being done
    """

    def __init__(
        self,
        package: Package,
        folder: pathlib.Path,
        timeout: float,
        progress: Callable[[str], None],
    ) -> None:
        self.package, self.timeout, self.progress = package, timeout, progress
        self.folder, self.given = folder / "workspace", folder / "given"
        self.given.mkdir()
        self.folder.mkdir(mode=0o700)
        self.package_folder = self.folder / "src" / package.root.resolve().name
        for path in package.files:
            target = self.package_folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(package.root / path, target)
        self._pool = concurrent.futures.ThreadPoolExecutor(max_workers=_AT_ONCE)

    def close(self) -> None:
        """Wait for what still runs."""
        self._pool.shutdown(wait=True)

    def submit(
        self, function: Callable[..., T], *arguments: object, **keywords: object
    ) -> concurrent.futures.Future[T]:
        """Run a function in the background; return its future."""
        return self._pool.submit(function, *arguments, **keywords)

    def run(
        self,
        *command: str,
        seconds: float | None = None,
        writable: Sequence[str] = (),
        env: Mapping[str, str] | None = None,
    ) -> confine.Result:
        """Run a command, confined, with this machine's own ROS. Raises ConfineError.

        seconds: that it may take, if not all of the timeout
        writable: folders that it may write to, with the workspace
        env: variables that come on top
        """
        return confine.run(
            sourced(command),
            self.folder,
            confine.Limits(time=seconds or self.timeout),
            {**variables.environment(self.folder), **(env or {})},
            readable=[self.given],
            writable=writable,
        )

    @property
    def ros_packages(self) -> str:
        """The ROS_PACKAGE_PATH of the copy and of this machine's own packages."""
        folders = [self.folder / "src", *map(pathlib.Path, SHARES)]
        return ":".join(str(folder) for folder in folders if folder.is_dir())


def search_path() -> str:
    return "/usr/bin:/bin:/usr/sbin:/sbin" + (":/opt/ros/noetic/bin" if NOETIC.exists() else "")


def sourced(command: Sequence[str]) -> list[str]:
    """Return a command that runs with this machine's own ROS."""
    if not NOETIC.exists():
        return list(command)
    return ["bash", "-c", 'source "$0" && exec "$@"', str(NOETIC), *command]
