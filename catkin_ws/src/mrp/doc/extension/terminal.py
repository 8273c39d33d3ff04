# SPDX-License-Identifier: BSD-3-Clause
"""Directive that shows what the reader types into a terminal, and what comes back.

.. terminal:: 1
   :until: received message with data = 8
   :output: pub_sub

   roslaunch mrp pub_sub.launch

The argument is the terminal's number: each is a shell of its own. The lines are the commands, and
tools/run_page.py types them. Options:

until: a regular expression. The last command goes on until it has printed a line that has it; then
    the reader presses Ctrl-C, unless `keep` is set.
keep: the command goes on while the reader reads on; `.. terminal:: 1` with `stop` ends it.
stop: the reader presses Ctrl-C in this terminal. There are no commands then.
exit: the exit code that the last command must have, if it is not 0.
output: the name in recorded/outputs.json for what the last command printed. It is recorded by
    tools/record_pages.py, and never typed.
only: a regular expression: of what was printed, only lines that have it are shown, and compared.
    The last line of the box says how many lines are left out.
shows: what these lines must show, one text per line: see meaning.py. Times, numbers of processes,
    ports and values are not compared otherwise.
graph: the name in recorded/graphs.json for the graph (see picture.py) at this moment.

When the site is built, all steps of its reader go into the file steps.json, in the order of
reading: tools/run_page.py does them.
"""

import json
import pathlib

import meaning
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.directives.code import container_wrapper
from sphinx.util.docutils import SphinxDirective


class Terminal(SphinxDirective):
    required_arguments = 1
    has_content = True
    option_spec = {
        "until": directives.unchanged_required,
        "keep": directives.flag,
        "stop": directives.flag,
        "exit": int,
        "output": directives.unchanged_required,
        "only": directives.unchanged_required,
        "shows": directives.unchanged_required,
        "graph": directives.unchanged_required,
    }

    def run(self):
        options = self.options
        commands = [line for line in self.content if line]
        if bool(commands) == ("stop" in options):
            raise self.error("a terminal has either commands or the option 'stop'")
        add_step(
            self.env,
            kind="terminal",
            terminal=self.arguments[0],
            commands=commands,
            line=self.lineno,
            **{name: True if value is None else value for name, value in options.items()},
        )
        result = []
        if commands:
            block = self.block("\n".join(commands), "bash", "terminal")
            result.append(container_wrapper(self, block, f"Terminal {self.arguments[0]}"))
        if "stop" in options:
            text = f"In terminal {self.arguments[0]}, press Ctrl-C."
            result.append(nodes.paragraph(text, text))
        if "output" in options:
            lines = recorded(self, "outputs.json", options["output"])
            if lines is not None:
                self.hold(lines)
                result.append(self.block("\n".join(lines), "text", "output"))
        if "until" in options and "keep" not in options:
            text = "Ctrl-C ends it."
            result.append(nodes.paragraph(text, text))
        return result

    def hold(self, lines):
        """Raise the directive's error if what is recorded does not show what the page says."""
        missing = meaning.missing(self.options.get("shows", "").splitlines(), lines)
        if missing and not self.config.recording:
            raise self.error(f"expected in {self.options['output']}: {missing}; found {lines}")

    def block(self, text, language, css_class):
        block = nodes.literal_block(text, text, language=language, classes=[css_class])
        self.set_source_info(block)
        return block


def recorded(directive, file, name):
    """Return what a file in recorded/ has under a name; while pages are recorded, perhaps None.

    Raises the directive's error if there is nothing.
    """
    path = pathlib.Path(directive.env.srcdir) / "recorded" / file
    directive.env.note_dependency(str(path))
    found = json.loads(path.read_text()).get(name)
    if found is None and not directive.config.recording:
        raise directive.error(f"{name} is not recorded yet in {file}: run make docs-record")
    return found


def add_step(env, **step):
    """Add a step of the page that is being read."""
    step["page"] = env.docname
    env.metadata[env.docname].setdefault("steps", []).append(step)


def _write_steps(app, exception):
    if exception is None and app.builder.format == "html":
        env = app.env
        order = [env.config.root_doc, *env.toctree_includes.get(env.config.root_doc, [])]
        steps = [step for docname in order for step in env.metadata[docname].get("steps", [])]
        (pathlib.Path(app.outdir) / "steps.json").write_text(json.dumps(steps, indent=1))


def setup(app):
    # True while tools/record_pages.py builds the site to record what the pages still lack.
    app.add_config_value("recording", False, "")
    app.add_directive("terminal", Terminal)
    app.connect("build-finished", _write_steps)
    return {"parallel_read_safe": False}
