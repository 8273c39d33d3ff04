# SPDX-License-Identifier: BSD-3-Clause
"""What is given as args reaches the node as one word each: roslaunch parts it at each space.

https://wiki.ros.org/roslaunch/XML/node
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule

_ARG = re.compile(r"(?<![\"'])\$\(arg (\w+)\)(?![\"'])")
_PART = re.compile(r"\$\([^()]*\)")  # what roslaunch puts a text for


def _findings(case: Case) -> Iterator[Finding]:
    for launch in case.launches:
        tags = launch.elements(case.package)
        texts = {
            element.attributes.get("name"): _PART.sub("x", element.attributes.get("default", ""))
            for _, element in tags
            if element.tag == "arg"
        }
        for file, element in tags:
            given = element.attributes.get("args", "") if element.tag == "node" else ""
            for name in _ARG.findall(given):
                words = texts.get(name, "").strip().split()
                if len(words) > 1 and not any(re.match(r"-|.*[:=]", word) for word in words):
                    if not re.fullmatch(r"[-\d.\s]+", texts[name].strip()):
                        yield Finding(
                            "launch-nodes",
                            f"The node gets {len(words)} arguments for $(arg {name}), which is a"
                            f" text with spaces: the first one is {words[0]}.",
                            file,
                            element.line,
                            WARNING,
                            expected=f"args=\"'$(arg {name})'\"",
                            seen=given,
                            fix=f"Put $(arg {name}) between single quotation marks.",
                        )


RULE = Rule("files", 44, ("launch",), _findings, also=("launch-nodes",), only=ANY)
