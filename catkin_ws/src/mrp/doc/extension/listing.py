# SPDX-License-Identifier: BSD-3-Clause
"""Directives that list what there is.

.. labs::        every lab: its claim, its launch file, its tests
.. exercises::   every exercise: the task, what is to be done, the page that explains it, and the
                 erratum that it is made of
"""

import re
import sys

import cases
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

LABS = cases.WORKSPACE / "src" / "mrp_labs"
# For the directives that list what the checker has.
sys.path.insert(0, str(cases.WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402


class Generated(SphinxDirective):
    """A directive that stands for reStructuredText made of the workspace's files."""

    def run(self):
        container = nodes.section()
        container.document = self.state.document
        lines = StringList(self.text().splitlines(), source=self.get_source_info()[0])
        self.state.nested_parse(lines, self.content_offset, container, match_titles=True)
        return container.children


class Labs(Generated):
    """Each lab: its claim is proved by `make lab`, and by the tests that start its launch file."""

    def run(self):
        found = super().run()
        tests = {
            f"mrp_labs/{path.stem[len('test_') :]}/{name}": case
            for path in sorted(LABS.glob("test/test_*.*"))
            for name, case in cases.in_file(path).items()
        }
        sections = [node for node in found if isinstance(node, nodes.section)]
        for section, launch in zip(sections, self.launch_files()):
            name = f'"{launch.name}"'
            starts = [test for test, case in tests.items() if name in case.source]
            of_file = [test for test, case in tests.items() if name in case.path.read_text()]
            next(section.findall(nodes.paragraph))["tests"] = [
                *(starts or of_file),
                f"lab/{launch.stem}",
            ]
        return found

    def launch_files(self):
        return sorted((LABS / "launch").glob("*.launch"))

    def text(self):
        parts = []
        for launch in self.launch_files():
            claim = re.fullmatch(r"<!-- (.*) -->", launch.read_text().splitlines()[0]).group(1)
            parts += [
                f".. _lab-{launch.stem}:",
                "",
                launch.stem.replace("_", " ").capitalize(),
                "-" * len(launch.stem),
                "",
                claim,
                "",
                ".. code-block:: bash",
                "",
                f"   make lab NAME={launch.stem}",
                "",
                f".. literalinclude:: /../../mrp_labs/launch/{launch.name}",
                "   :language: xml",
                "",
            ]
        return "\n".join(parts)


class Exercises(Generated):
    def text(self):
        return "\n".join(map(self.line, defects.exercises()))

    def line(self, exercise):
        self.env.note_dependency(str(exercise.path))
        number = exercise.erratum
        erratum = f", `{number} <errata.html#{number.lower()}>`__" if number else ""
        return f"#. **{exercise.title}** ({exercise.kind}): :doc:`{exercise.page}`{erratum}"


def setup(app):
    app.add_directive("labs", Labs)
    app.add_directive("exercises", Exercises)
    return {"parallel_read_safe": False}
