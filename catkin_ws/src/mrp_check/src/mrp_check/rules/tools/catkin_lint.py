# SPDX-License-Identifier: BSD-3-Clause
"""What catkin_lint says of package.xml and CMakeLists.txt: good to know, and so notes.

https://fkie.github.io/catkin_lint/messages/
"""

from __future__ import annotations

import json
import shutil
from concurrent.futures import Future
from typing import Iterator

from mrp_check.build.catkin import search_path
from mrp_check.build.row import Row
from mrp_check.contract.errors import CannotCheck, NotHere
from mrp_check.contract.finding import HINT, Finding
from mrp_check.contract.requirements import ANY, Requirement, Rule
from mrp_check.contract.resources import SHARES
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.sandbox.confine import Result

_AGREE = "Name the same packages in package.xml, find_package() and catkin_package()."
_INSTALL = "Add it to install(); or leave it, if you only work in your own workspace."
_TABLE = {
    "MISSING_CATKIN_DEPEND": Row(
        "catkin_package() doesn't pass on a package that this one needs.", _AGREE
    ),
    "UNCONFIGURED_BUILD_DEPEND": Row(
        "package.xml names a package that CMakeLists.txt doesn't look for.", _AGREE
    ),
    "UNCONFIGURED_MSG_DEPEND": Row(
        "generate_messages() names a package that find_package() doesn't.", _AGREE
    ),
    "UNGUARDED_TEST_CMD": Row(
        "A test is built even where nobody wants tests.",
        "Put it between if(CATKIN_ENABLE_TESTING) and endif().",
    ),
    "UNINSTALLED_INCLUDE_PATH": Row("The package's headers aren't installed.", _INSTALL),
    "UNINSTALLED_SCRIPT": Row("A script isn't installed.", _INSTALL),
    "UNINSTALLED_TARGET": Row("An executable or a library isn't installed.", _INSTALL),
    "UNUSED_DEPEND": Row("package.xml names a package that nothing uses.", _AGREE),
    "WRONG_DEPEND": Row("package.xml names a package for the wrong time.", _AGREE),
}


def _begin(case: Case) -> Future[Result] | None:
    """Start catkin_lint, if it is there and if this is a package of catkin's."""
    parsed, _ = case.manifest
    tools = {tool.name for tool in parsed.buildtool_depends} if parsed else set()
    is_catkins = "catkin" in tools and "CMakeLists.txt" in case.package.files
    if not is_catkins or not shutil.which("catkin_lint", path=search_path()):
        return None
    command = ("catkin_lint", "--offline", "--json", "-W2", "--package-path", ":".join(SHARES))
    return case.tool("catkin_lint", case.run, *command, str(case.package_folder))


def _findings(case: Case) -> Iterator[Finding]:
    package = case.package
    if not shutil.which("catkin_lint", path=search_path()):
        raise NotHere(["catkin_lint (Debian package catkin-lint)"])
    running = _begin(case)
    if not running:
        return
    done = running.result()
    try:
        report = json.loads(done.output)
    except ValueError:
        raise CannotCheck(f"catkin_lint failed: {done.errors.strip()[-300:]}") from None
    for entry in (entry for kind in ("errors", "warnings", "notices") for entry in report[kind]):
        row, place = _TABLE.get(entry["id"]), entry["location"]
        file, line = place.get("file", "CMakeLists.txt"), place.get("line")
        named = entry["text"].split("'")[1::2]
        # Any file may have the permission to be run, such as what comes from Windows.
        is_script = "SCRIPT" not in entry["id"] or any(package.kind(n) == "python" for n in named)
        if row and is_script and file in package.files:
            name = f"catkin_lint calls {entry['id'].lower()}"
            row = row._replace(certainty=HINT)
            yield row.finding("catkin-lint", package, file, line, name, entry["text"])


RULE = Rule(
    stage="build",
    needs=("manifest", "model"),
    findings=_findings,
    begins=_begin,
    requirements={
        "catkin-lint": Requirement(
            "catkin_lint has nothing to say", "building#cmakelists-txt", evidence.manifest
        )
    },
    only=ANY,
)
