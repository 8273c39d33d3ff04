# SPDX-License-Identifier: BSD-3-Clause
"""What stands in for a package that this machine has not: an empty one, so that CMake goes on, and
what does not need it is built and checked. What does need it lacks its headers: it is unchecked."""

from __future__ import annotations

import pathlib
import re
import shutil

from mrp_check.contract.names import nearest
from mrp_check.package.package import Package

PACKAGES = ["roscpp", "rospy", "std_msgs", "catkin", "message_generation", "roslib"]
ALIKE = 0.8  # of a misspelt name; nav_msgs and std_msgs, two packages, are 0.63
# Their group is the name of a package that CMake did not find.
NOT_FOUND = (
    r'Could not find a package configuration file provided by "(\w+)"',
    r"catkin_package\(\).*?on the catkin package '(\w+)'",
    r"Could NOT find (\w+)",
)
# Without these, what is made of the package's own definitions would be wrong.
_NEEDED = ("message_generation", "message_runtime", "genmsg", "dynamic_reconfigure")
_CONFIG = """set({name}_FOUND TRUE)
set({name}_FOUND_CATKIN_PROJECT TRUE)
"""


def absent(package: Package, output: str, is_contract: bool = True) -> str | None:
    """Return the package that CMake did not find though package.xml asks for it, and that looks
    like no other's misspelt name; or None. Without a contract, any package may be asked for."""
    found = (re.search(shape, output) for shape in NOT_FOUND)
    name = next((match.group(1) for match in found if match), None)
    asked = not is_contract or name and package.find_line("package.xml", f">{name}<")
    return name if name and asked and not nearest(name, PACKAGES, ALIKE) else None


class Stubs:
    """The packages that are stood in for, in a folder of their own."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder

    @property
    def names(self) -> list[str]:
        return sorted(path.name for path in self.folder.iterdir()) if self.folder.exists() else []

    def add(self, name: str) -> bool:
        """Stand in for a package; return whether that may help."""
        if name in self.names or name in _NEEDED:
            return False
        (self.folder / name).mkdir(parents=True)
        for file in (f"{name}Config.cmake", f"{name.lower()}-config.cmake"):
            (self.folder / name / file).write_text(_CONFIG.format(name=name))
        return True

    def clear(self) -> None:
        """Stand in for nothing."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def flags(self) -> list[str]:
        """Return the arguments with which CMake finds them."""
        return [f"-D{name}_DIR={self.folder / name}" for name in self.names]
