# SPDX-License-Identifier: BSD-3-Clause
"""What a build collects page by page: Sphinx keeps it until the page is read again."""


def keep(app, name):
    """Have the environment's attribute `name`: a dictionary whose keys are pages."""

    def begin(app, env, docnames):
        if not hasattr(env, name):
            setattr(env, name, {})

    def forget(app, env, docname):
        getattr(env, name, {}).pop(docname, None)

    app.connect("env-before-read-docs", begin)
    app.connect("env-purge-doc", forget)
