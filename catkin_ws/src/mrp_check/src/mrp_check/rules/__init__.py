# SPDX-License-Identifier: BSD-3-Clause
"""The rules: each file is one, and stands in the tuple below.

RULES: in the order in which they are asked, causes before what follows from them
REQUIREMENTS: id -> Requirement, in the same order
OF_CONTRACT: those of them that a contract can ask for
"""

from __future__ import annotations

from mrp_check.contract.requirements import ANY
from mrp_check.rules.code import (
    callbacks,
    goals,
    homes,
    ignored,
    lifetime,
    node_start,
    not_called,
    python_names,
    rospy_calls,
    same_name,
    spin,
    typed,
)
from mrp_check.rules.contract import (
    console,
    counter,
    examples,
    install,
    latch,
    launch_contract,
    launch_moved,
    own_name,
    queue,
    rate,
    received,
    services,
    swapped_sources,
    topic,
    values,
)
from mrp_check.rules.files import (
    cmake,
    dependencies,
    launch_file,
    launch_nodes,
    manifest,
    messages,
    package_name,
    scripts,
    targets,
    text,
)
from mrp_check.rules.run import (
    called_back,
    compile,
    configure,
    exceptions,
    exit,
    first_message,
    meeting,
    starts,
    warnings,
)
from mrp_check.rules.tools import catkin_lint, gcc, pylint

_FILES = (
    # files
    manifest,
    dependencies,
    package_name,
    cmake,
    targets,
    messages,
    scripts,
    text,
    launch_file,
    launch_nodes,
    launch_contract,
    install,
    # static
    python_names,
    rospy_calls,
    not_called,
    swapped_sources,
    node_start,
    typed,
    spin,
    callbacks,
    lifetime,
    queue,
    counter,
    homes,
    same_name,
    goals,
    ignored,
    # build
    pylint,
    catkin_lint,
    configure,
    compile,
    gcc,
    # run
    starts,
    own_name,
    exceptions,
    called_back,
    first_message,
    topic,
    meeting,
    examples,
    values,
    rate,
    latch,
    received,
    services,
    console,
    warnings,
    launch_moved,
    # stop
    exit,
)
RULES = tuple(file.RULE for file in _FILES)
REQUIREMENTS = {
    id_: requirement._replace(stage=rule.stage)
    for rule in RULES
    for id_, requirement in rule.requirements.items()
}
OF_CONTRACT = {
    id_: REQUIREMENTS[id_] for rule in RULES if rule.only != ANY for id_ in rule.requirements
}
