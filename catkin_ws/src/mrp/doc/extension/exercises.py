# SPDX-License-Identifier: BSD-3-Clause
"""Directive `exercises`: the list of the exercises that are checked, in their order.

Each is named as its task is, with what is to be done, the page that explains it, and the erratum
that it is made of.
"""

from listing import Generated
from mrp_check.contract import defects


class Exercises(Generated):
    def text(self):
        return "\n".join(self.line(one) for one in defects.exercises())

    def line(self, one):
        self.env.note_dependency(str(one.path))
        erratum = f", `{one.erratum} <errata.html#{one.erratum.lower()}>`__" if one.erratum else ""
        return f"#. **{one.title}** ({one.kind}): :doc:`{one.page}`{erratum}"


def setup(app):
    app.add_directive("exercises", Exercises)
    return {"parallel_read_safe": False}
