# SPDX-License-Identifier: BSD-3-Clause
"""package.xml names the libraries and Python modules of others that the sources use, too: rosdep
installs what is named there. https://docs.ros.org/independent/api/rosdep/html/
"""

from __future__ import annotations

import sys
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.code.python_modules import is_ros
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.package.manifest import declared

# Folder of headers, or module -> a part of the names by which package.xml may have it, and rosdep's
# own name of it.
_LIBRARIES = {
    "yaml-cpp": (("yaml",), "yaml-cpp"),
    "opencv2": (("opencv", "cv_bridge"), "libopencv-dev"),
    "cv2": (("opencv", "cv_bridge"), "python3-opencv"),
    "PIL": (("pil",), "python3-pil"),
    "sklearn": (("sklearn", "scikit"), "python3-sklearn"),
}
# They come with ROS itself, or with Python.
_BROUGHT = {*sys.builtin_module_names, "yaml", "rospkg", "catkin_pkg", "genpy", "setuptools", "em"}


def _findings(case: Case) -> Iterator[Finding]:
    package, (manifest, _) = case.package, case.manifest
    if manifest is None:
        return
    names = {one.lower() for known in declared(manifest).values() for one in known}
    said: set[str] = set()
    for file, line, module in _used(case):
        top = module.partition(".")[0]
        is_package = module.endswith((".msg", ".srv"))
        parts, key = _LIBRARIES.get(top, ((top.lower().replace("_", "-"), top.lower()), ""))
        key = key or (top if is_package else f"python3-{top.lower().replace('_', '-')}")
        if top in said or any(part in name for part in parts for name in names):
            continue
        said.add(top)
        yield Finding(
            "dependencies",
            f"{file} uses {top}, and package.xml does not name it: where it is not installed, this"
            " fails.",
            file,
            line,
            HABIT,
            expected=f"<depend>{key}</depend> in package.xml",
            seen=package.line(file, line),
            fix=f"Add <depend>{key}</depend> to package.xml; or take the line out if nothing of it"
            " is used.",
        )


def _used(case: Case) -> Iterator[tuple[str, int, str]]:
    """Yield (file, line, module or folder of headers) of what others than ROS made."""
    package = case.package
    for file in package.of_kind("cpp", "header"):
        for header, line in () if uses.is_test(file) else uses.includes(package, file):
            if header.partition("/")[0] in _LIBRARIES:
                yield file, line, header.partition("/")[0]
    paths, made = [f"/{path}" for path in package.of_kind("python")], uses.made(package)
    for file in package.of_kind("python"):
        if uses.is_test(file) or file in ("setup.py", "doc/conf.py"):
            continue
        for module, line in uses.imports(package, file):
            top = module.partition(".")[0]
            is_own = any(f"/{top}/" in path or path.endswith(f"/{top}.py") for path in paths)
            is_others = top in uses.STANDARD | _BROUGHT or is_ros(top) or uses.is_called_so(top)
            is_package = module.endswith((".msg", ".srv"))
            # Of its own definitions, the name is an old one: another rule says so.
            is_old = is_package and any(one in package.line(file, line) for one in made)
            if not is_own and not is_others and not is_old and top != package.name:
                if uses.is_of_debian(top) or is_package:
                    yield file, line, module


RULE = Rule("files", ("manifest",), _findings, also=("dependencies",), only=ANY)
