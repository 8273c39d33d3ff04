# SPDX-License-Identifier: BSD-3-Clause
"""catkin_make on the package's copy, in its two steps: configuring first, and then building, while
other stages go on."""

from __future__ import annotations

import concurrent.futures
import functools
import json
import os
import shlex
import shutil
import typing

from mrp_check import releases, sandbox
from mrp_check.build.stubs import Stubs, absent
from mrp_check.confined import variables, written
from mrp_check.contract.errors import CannotCheck
from mrp_check.package import cmake
from mrp_check.package.workspace import Workspace, search_path
from mrp_check.sandbox import confine

# program -> the Debian package that has it
TOOLS = {
    "bwrap": "bubblewrap",
    "catkin_make": "catkin",
    "cmake": "cmake",
    "g++": "g++",
    "make": "make",
    "roslaunch": "python3-roslaunch",
}
WANTS_TESTS = "is not available when tests are not enabled"  # what catkin says of its own macros
# An executable of an earlier build must not stand in for one that cannot be built now.
_ANEW = 'find "$0/devel/lib" -type f -newer "$0/build/Makefile" -delete; exec "$@"'
_KEEP_GOING = ("--no-print-directory", "-k", "-j2")


class Step(typing.NamedTuple):
    """What came of configuring or building: whether it succeeded, and what it printed."""

    ok: bool
    output: str
    why_ended: str = ""  # the limit that it broke, as a sentence's part


def missing_tool() -> str | None:
    """Return a sentence that names a tool which is not installed, or None."""
    for program, package in TOOLS.items():
        if not shutil.which(program, path=search_path()):
            return f"{program} isn't installed: install Debian's package {package} (make deps)."
    return None


class Catkin:
    """catkin_make in the scratch workspace of a check. Everything runs confined, and only once."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.folder = workspace.folder
        # Where the package's own programs cannot write.
        self.stubs = Stubs(workspace.given / "stubs")
        self._building: concurrent.futures.Future[Step] | None = None

    def _configure(self, tests: str = "OFF") -> confine.Result:
        """Run catkin_make up to its last step, which is `make`.

        tests: whether there are to be tests, too
        """
        trace = self.folder / "trace.json"
        package = self.workspace.package_folder
        files = [*package.rglob("CMakeLists.txt"), *package.rglob("*.cmake")]
        sources = [f"--trace-source={path.relative_to(package.parent)}" for path in files]
        return self._run(
            "catkin_make",
            *("-C", str(self.folder)),
            "--cmake-args",
            "-DPYTHON_EXECUTABLE=/usr/bin/python3",
            f"-DCATKIN_ENABLE_TESTING={tests}",
            "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
            "-Wno-dev",
            *self.stubs.flags(),
            *("--trace-expand", "--trace-format=json-v1", f"--trace-redirect={trace}", *sources),
            *("--make-args", "help"),
        )

    def _run(self, *command: str) -> confine.Result:
        """Run a command that may call the compiler."""
        environment = {**self.compiler_environment(), "CXXFLAGS": self.workspace.compiler_flags}
        environment[releases.CMAKE_VARIABLE] = releases.CMAKE_VALUE
        cache = environment.get("CCACHE_DIR")
        if cache:
            os.makedirs(cache, exist_ok=True)  # within the confinement it could not be made
            if os.getuid() == 0:
                os.chmod(cache, 0o777)  # each check is another user's then
        return self.workspace.run(*command, writable=[cache] if cache else [], env=environment)

    def _step(self, result: confine.Result) -> Step:
        """Return the Step that came of a command. Raises CannotCheck if it took too long.

        What computes without end is ended by the limit of its processor time, and is the package's
        fault; what only lasts may be the machine's.
        """
        limits = confine.Limits(time=self.workspace.timeout)
        if result.ended_by == "time":
            raise CannotCheck(
                f"catkin_make didn't end within {limits.time:.0f} s: the machine is too busy, or"
                " CMakeLists.txt waits for something; --timeout gives it more time."
            )
        why = result.limit_text(limits) or "" if result.ended_by else ""
        return Step(result.code == 0, result.output + "\n" + result.errors, why)

    @staticmethod
    def compiler_environment() -> dict[str, str]:
        """Return the variables with which the compiler's messages are plain, in English."""
        found = {"GCC_COLORS": "", "VERBOSE": "", "CLICOLOR": "0", "PATH": search_path()}
        cache = os.environ.get(variables.CCACHE)
        # Without it where the package's user cannot reach it, as below root's home.
        if cache and shutil.which("ccache") and sandbox.reaches(cache):
            found["PATH"] = "/usr/lib/ccache:" + search_path()
            found.update(
                CCACHE_DIR=cache,
                CCACHE_NOHASHDIR="1",
                CCACHE_UMASK="000",
                CCACHE_BASEDIR="/",
                CCACHE_DEPEND="1",  # what is new is compiled at once, and not preprocessed before
            )
        return found

    @functools.cached_property
    def configured(self) -> Step:
        """The Step of `catkin_make`'s first half: CMake."""
        if self.workspace.configured:
            return Step(*self.workspace.configured)
        self.stubs.clear()
        self.workspace.progress("configuring with CMake")
        step = self._step(self._configure())
        if not step.ok and WANTS_TESTS in " ".join(step.output.split()):
            # So a package is built that Debian could not build; a rule says so.
            again = self._step(self._configure("ON"))
            return again._replace(output=f"{step.output}\n{again.output}") if again.ok else again
        return step if step.ok or not self.workspace.stands_in else self._without(step)

    def _without(self, first: Step) -> Step:
        """Return the Step of CMake with stubs for what this machine has not; or the first Step, if
        that does not help, and nothing is stood in for."""
        step, package = first, self.workspace.package
        while not step.ok:
            name = absent(package, step.output, is_contract=False)
            if not name or not self.stubs.add(name):
                self.stubs.clear()
                if step is not first:
                    self._configure()  # what CMake's trace says belongs to the first Step
                return first
            step = self._step(self._configure())
        return step

    @functools.cached_property
    def model(self) -> cmake.Model:
        """What CMakeLists.txt says, as a cmake.Model."""
        configured = self.configured
        calls = cmake.traced(self.folder / "trace.json", self.workspace.package_folder)
        return cmake.Model(self.workspace.package_folder, calls, configured.ok, configured.output)

    def start_building(self) -> None:
        """Begin to build in the background, if CMake succeeded."""
        if self._building is None and self.configured.ok:
            self._building = self.workspace.submit(self._build)

    def _build(self) -> Step:
        workspace = self.workspace
        if workspace.made:
            step = Step(*workspace.made)
            workspace.keep(self.configured, step)
            return step
        # As catkin_make would, which took its time to find out that CMake need not run again.
        make = ["make", f"--directory={self.folder / 'build'}", *_KEEP_GOING]
        if workspace.compiles_again:
            make = ["bash", "-c", _ANEW, str(self.folder), *make]
        # Whether a target can be built that does not wait for its headers depends on chance; what
        # its node then does must not. A rule tells of such targets.
        made = (f"{workspace.package.name}_{what}" for what in ("generate_messages", "gencfg"))
        first = [target for target in made if target in self.model.made]
        if first:
            result = self._run(*make, *first)
        if workspace.static:
            workspace.keep(self.configured, None)
            return self._step(result) if first else Step(True, "")
        result = self._run(*make)
        step = self._step(result)
        if result.ended_by is None:
            workspace.keep(self.configured, step)
        return step

    @functools.cached_property
    def built(self) -> Step | None:
        """The Step of `catkin_make`'s second half, or None if CMake failed."""
        self.start_building()
        if self._building is None:
            return None
        if not self.workspace.made:
            self.workspace.progress("building")
        return self._building.result()

    def wait_until_built(self) -> None:
        """Wait until building has ended, if CMake succeeded; `built` says how."""
        self.start_building()
        if self._building is not None:
            concurrent.futures.wait([self._building])

    def compile_commands(self) -> dict[str, tuple[str, list[str]]]:
        """Return source (path within the copy) -> arguments of its compiler."""
        path = self.folder / "build" / "compile_commands.json"
        try:
            entries = json.loads(written.read(path))
        except (OSError, ValueError):
            return {}
        return {
            entry["file"]: (entry["directory"], shlex.split(entry["command"])) for entry in entries
        }
