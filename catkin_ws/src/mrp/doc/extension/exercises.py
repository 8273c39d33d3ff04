# SPDX-License-Identifier: BSD-3-Clause
"""Directive `exercises`: the list of the exercises that are checked, in their order.

Each is named as its task is, with the erratum that it is made of.
"""

import pathlib
import re

from proof import WORKSPACE, Generated

FOLDER = WORKSPACE / "src" / "mrp_check" / "exercises"


class Exercises(Generated):
    def text(self):
        return "\n".join(self.line(path.parent) for path in sorted(FOLDER.glob("*/task.md")))

    def line(self, folder: pathlib.Path):
        title = (folder / "task.md").read_text().splitlines()[0].lstrip("# ")
        patch = (folder / "solution.patch").read_text()
        erratum = re.match(r"Mends: (\w+),", patch).group(1)
        self.env.note_dependency(str(folder / "task.md"))
        return f"#. **{title}**: `{erratum} <errata.html#{erratum.lower()}>`__"


def setup(app):
    app.add_directive("exercises", Exercises)
    return {"parallel_read_safe": False}
