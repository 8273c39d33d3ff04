# SPDX-License-Identifier: BSD-3-Clause
"""What generate() in a .cfg file of dynamic_reconfigure makes is called as CMake expects it.

https://wiki.ros.org/dynamic_reconfigure/Tutorials/HowToWriteYourFirstCfgFile
"""

from __future__ import annotations

import pathlib
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of

_GENERATE = re.compile(
    r"""^[^#\n]*\bgenerate\s*\([^,()]+,[^,()]+,\s*["'](\w+)["']\s*\)""", re.MULTILINE
)


def _findings(case: Case) -> Iterator[Finding]:
    for file in case.package.files:
        stem = pathlib.PurePosixPath(file).stem
        match = _GENERATE.search(case.package.text(file)) if file.endswith(".cfg") else None
        if match and match[1] != stem:
            line = line_of(match, 1)
            yield Finding(
                "messages",
                f"{file} makes {match[1]}Config.h, and CMake waits for {stem}Config.h: the third"
                " argument of generate() has to be the name of the file.",
                file,
                line,
                WARNING,
                expected=stem,
                seen=case.package.line(file, line),
                fix=f"Write {stem} for {match[1]}.",
                change=(f'"{match[1]}")', f'"{stem}")'),
            )


RULE = Rule("files", 61, (), _findings, also=("messages",), only=ANY)
