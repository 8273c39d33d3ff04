# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong: each file is a rule, which has its name nowhere else.

RULES: all rules, in the order in which they are asked
REQUIREMENTS: id -> Requirement, in the order in which they are shown
"""

from __future__ import annotations

import importlib
import pkgutil

from mrp_check.contract.requirements import STAGES, Requirement

_NAMES = [f"{__name__}.{file.name}" for file in pkgutil.iter_modules(__path__)]
RULES = [importlib.import_module(name).RULE for name in _NAMES]
RULES.sort(key=lambda rule: (STAGES.index(rule.stage), rule.order))


def _requirements() -> dict[str, Requirement]:
    found = [
        (rule.order if one.shown is None else one.shown, id_, one._replace(stage=rule.stage))
        for rule in RULES
        for id_, one in rule.requirements.items()
    ]
    found.sort(key=lambda entry: (STAGES.index(entry[2].stage), entry[0]))
    return {id_: one for _, id_, one in found}


REQUIREMENTS = _requirements()
