# SPDX-License-Identifier: BSD-3-Clause
"""What a reader of the pages does, step by step, in the order of reading.

When the site is built, all steps go into the file steps.json, from which tools/run_page.py does
them.
"""

import json
import pathlib


def add_step(env, **step):
    """Add a step of the page that is being read."""
    step["page"] = env.docname
    env.metadata[env.docname].setdefault("steps", []).append(step)


def _write(app, exception):
    if exception is None and app.builder.format == "html":
        env = app.env
        order = [env.config.root_doc, *env.toctree_includes.get(env.config.root_doc, [])]
        steps = [step for docname in order for step in env.metadata[docname].get("steps", [])]
        (pathlib.Path(app.outdir) / "steps.json").write_text(json.dumps(steps, indent=1))


def connect(app):
    """Have the steps collected while the pages are read, and written when all is built."""
    app.connect("build-finished", _write)
