# SPDX-License-Identifier: BSD-3-Clause
"""Dataclasses as JSON: what crosses from one process to another, and is checked where it arrives.

No module that has one delays its annotations: from_json() goes by them, on Python 3.8, too.
"""

import dataclasses
import enum
import functools
import json
import typing

T = typing.TypeVar("T")


class CrossingError(ValueError):
    """What has arrived has not the expected form; the text is one sentence."""


def to_json(value: object) -> str:
    """Return a dataclass, or a container of some, as one line of JSON."""
    return json.dumps(value, default=_plain)


def from_json(kind: typing.Type[T], text: typing.Union[str, bytes]) -> T:
    """Return the value of a type that to_json() wrote. Raises CrossingError."""
    try:
        data = json.loads(text)
    except ValueError as error:
        raise CrossingError(f"Expected {_name(kind)} as JSON; found none: {error}.") from None
    return typing.cast(T, _read(kind, data, _name(kind)))


def _plain(value: object) -> object:
    if isinstance(value, enum.Enum):
        return value.value
    if dataclasses.is_dataclass(value):
        # What has its default need not cross.
        return {
            field.name: getattr(value, field.name)
            for field in dataclasses.fields(value)
            if field.default is dataclasses.MISSING or getattr(value, field.name) != field.default
        }
    raise TypeError(f"{value!r} cannot be written as JSON")


def _read(kind: typing.Any, data: typing.Any, where: str) -> object:
    """Return data as the value of a type; where: its place in all, for the error."""
    origin, of = typing.get_origin(kind), typing.get_args(kind)
    if kind is object or kind is type(data) or kind is float and type(data) is int:
        return data
    if origin is typing.Union:
        return _first(of, data, where)
    if origin is list and isinstance(data, list):
        return [_read(of[0], item, f"{where}[{index}]") for index, item in enumerate(data)]
    if origin is tuple and isinstance(data, list) and len(data) == len(of):
        return tuple(_read(expected, part, where) for expected, part in zip(of, data))
    if origin is dict and isinstance(data, dict):
        return {key: _read(of[1], value, f"{where}.{key}") for key, value in data.items()}
    if dataclasses.is_dataclass(kind) and isinstance(data, dict):
        return _read_fields(kind, data, where)
    if isinstance(kind, enum.EnumMeta):
        members: typing.Iterable[enum.Enum] = kind.__members__.values()
        found = [member for member in members if member.value == data]
        if found:
            return found[0]
    raise CrossingError(f"{where}: expected {_name(kind)}; found {str(data)[:50]!r}.")


def _first(kinds: typing.Tuple[object, ...], data: object, where: str) -> object:
    """Return data as the value of the first of several types that it fits."""
    errors = []
    for kind in kinds:
        try:
            return _read(kind, data, where)
        except CrossingError as error:
            errors.append(error)
    raise errors[0]


def _read_fields(kind: typing.Any, data: typing.Dict[str, object], where: str) -> object:
    hints = _hints(kind)
    unknown = sorted(data.keys() - hints.keys())
    if unknown:
        raise CrossingError(f"{where}: expected the fields of {_name(kind)}; found {unknown[0]!r}.")
    values = {name: _read(hints[name], value, f"{where}.{name}") for name, value in data.items()}
    try:
        return kind(**values)
    except TypeError as error:
        raise CrossingError(f"{where}: expected a whole {_name(kind)}; {error}.") from None


@functools.lru_cache(maxsize=None)
def _hints(kind: typing.Any) -> typing.Dict[str, object]:
    return typing.get_type_hints(kind)


def _name(kind: object) -> str:
    return getattr(kind, "__name__", str(kind))
