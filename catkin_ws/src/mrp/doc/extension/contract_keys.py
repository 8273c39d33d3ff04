# SPDX-License-Identifier: BSD-3-Clause
"""Directive `contract-keys`: each key of a contract, as mrp_check's schema/spec.json says it."""

import json
import re

import cases
from listing import Generated
from mrp_check.contract.schema import words

SCHEMA = cases.WORKSPACE / "src" / "mrp_check" / "schema" / "spec.json"


class ContractKeys(Generated):
    def text(self):
        self.env.note_dependency(str(SCHEMA))
        schema = json.loads(SCHEMA.read_text())
        return "\n".join(_section("", schema, schema["definitions"]))


def _section(path, entry, definitions):
    """Yield the lines on what has keys of its own, and on what these have in turn.

    path: where it stands in the file, such as nodes.NAME.publishes
    """
    heading = f"``{path}``" if path else "The file"
    yield from (heading, "-" * len(heading), "")
    below = []
    for key, value in entry["properties"].items():
        value = {**_referred(value, definitions), **value}
        each = _referred(value.get("additionalProperties") or value.get("items") or {}, definitions)
        yield f"``{key}`` : {_marked_up(_taken(entry, key, value))}"
        yield from (f"   {_marked_up(value['description'])}", "")
        name = f"{path}.{key}".lstrip(".")
        below += [(name, value)] if "properties" in value else []
        named = name if "items" in value else f"{name}.NAME"
        below += [(named, each)] if "properties" in each else []
    for name, value in below:
        yield from _section(name, value, definitions)


def _referred(entry, definitions):
    """Return the definition that an entry refers to, or the entry itself."""
    return definitions[entry["$ref"].split("/")[-1]] if "$ref" in entry else entry


def _taken(entry, key, value):
    """Return what a key takes, in words, and whether it can be left out."""
    if key in entry.get("required", ()):
        return f"{words(value)}; required"
    default = value.get("default")
    return words(value) + ("" if default is None else f"; default: {json.dumps(default)}")


def _marked_up(text):
    """Return a text in which nothing is mark-up."""
    return re.sub(r"([\\*`|_])", r"\\\1", text)


def setup(app):
    app.add_directive("contract-keys", ContractKeys)
    return {"parallel_read_safe": False}
