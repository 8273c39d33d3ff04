# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a YAML file, in words: by YAML itself, or by a JSON schema."""

from __future__ import annotations

import typing
from typing import Any, Hashable, Iterable, Mapping

import yaml

from mrp_check.contract.names import nearest

if typing.TYPE_CHECKING:
    import jsonschema  # the site, which shows words(), is built without it

KINDS = {
    "object": "keys with values",
    "array": "a list",
    "string": "a text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
}
LIMITS = {
    "minimum": "at least",
    "maximum": "at most",
    "exclusiveMinimum": "more than",
    "minLength": "a length of at least",
    "minProperties": "entries: at least",
    "maxProperties": "entries: at most",
}


def words(entry: Mapping[str, Any]) -> str:
    """Return what a schema takes, in words: such as "a whole number, at least 1"."""
    if "enum" in entry:
        return f"one of: {', '.join(entry['enum'])}"
    kind = entry.get("title") or KINDS[entry["type"]]
    limits = ("exclusiveMinimum", "minimum", "maximum")
    return ", ".join([kind, *(f"{LIMITS[key]} {entry[key]}" for key in limits if key in entry)])


class Loader(yaml.SafeLoader):
    """Says when a key stands twice: plain YAML would take the last one, in silence."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and key.value in seen:
                raise yaml.MarkedYAMLError(
                    problem=f"the key '{key.value}' appears twice", problem_mark=key.start_mark
                )
            seen.add(getattr(key, "value", None) if isinstance(key, yaml.ScalarNode) else None)
        return super().construct_mapping(node, deep)


def listed(data: Any, entry: Mapping[str, Any], definitions: Mapping[str, Any]) -> Any:
    """Return what YAML says, with a list around what stands alone where the schema allows both."""
    entry = definitions[entry["$ref"].split("/")[-1]] if "$ref" in entry else entry
    if entry.get("alone") and data is not None and not isinstance(data, list):
        data = [data]
    if isinstance(data, list):
        return [listed(item, entry.get("items", {}), definitions) for item in data]
    if not isinstance(data, dict):
        return data
    known, other = entry.get("properties", {}), entry.get("additionalProperties") or {}
    return {key: listed(value, known.get(key, other), definitions) for key, value in data.items()}


def no_such(kind: str, name: str, names: Iterable[str]) -> str:
    return f"there's no {kind} '{name}'; there are: {', '.join(names)}." + near(name, names)


def near(name: str, names: Iterable[str]) -> str:
    near = nearest(name, names)
    return f" Did you mean '{near}'?" if near else ""


def sentence(error: jsonschema.ValidationError) -> str:
    """Return what is wrong, in words, for an error of jsonschema."""
    if error.validator == "additionalProperties":
        known = list(error.schema.get("properties", {}))
        unknown = sorted(str(key) for key in error.instance if key not in known)
        if known:
            return no_such("key", unknown[0], known)
    if error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        return f"expected the key '{missing[0]}'; it is missing."
    if error.validator == "type":
        one_of = isinstance(error.validator_value, list)
        kind = words(error.schema) if one_of else KINDS[error.validator_value]
        return f"expected {kind}; found {_shown(error.instance)}."
    if error.validator in ("enum", "pattern"):
        return f"expected {words(error.schema)}; found {_shown(error.instance)}."
    if error.validator in LIMITS:
        limit = f"{LIMITS[error.validator]} {error.validator_value}"
        return f"expected {limit}; found {_shown(error.instance)}."
    return f"{error.message}."


def _shown(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, (dict, list)) and not value:
        return "nothing"
    if isinstance(value, dict):
        return "keys with values"
    if isinstance(value, list):
        return "a list"
    return str(value).lower() if isinstance(value, bool) else repr(value)
