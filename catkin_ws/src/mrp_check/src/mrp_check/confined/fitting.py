# SPDX-License-Identifier: BSD-3-Clause
"""Whether a message is the one that an example of the contract says."""

import re
from typing import Dict, Optional, Sequence, Union

Plain = Union[bool, int, float, str]

_HOLDERS = {r"\{value\}": r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", r"\{any\}": r"[\s\S]*"}


def fits(wanted: Dict[str, Plain], found: Dict[str, Plain], tolerance: float) -> bool:
    """Return whether each field that is wanted is found, with its value."""
    return all(_same(value, found.get(path), tolerance) for path, value in wanted.items())


def _same(wanted: Plain, found: Optional[Plain], tolerance: float) -> bool:
    if isinstance(wanted, str):
        shape = re.escape(wanted)
        for holder, meaning in _HOLDERS.items():
            shape = shape.replace(holder, meaning)
        return isinstance(found, str) and re.fullmatch(shape, found) is not None
    return isinstance(found, (bool, int, float)) and abs(found - wanted) <= tolerance


def follow(
    wanted: Sequence[Dict[str, Plain]],
    found: Sequence[Dict[str, Plain]],
    tolerance: float,
    is_among: bool,
) -> Optional[bool]:
    """Return whether the wanted messages were found, one after the other: first of all, or among
    others. None: not yet all of them."""
    starts = range(max(len(found) - len(wanted), 0) + 1) if is_among else range(1)
    for start in starts:
        pairs = list(zip(wanted, found[start:]))
        if all(fits(*pair, tolerance) for pair in pairs):
            if len(pairs) == len(wanted):
                return True
        elif not is_among:
            return False
    return None
