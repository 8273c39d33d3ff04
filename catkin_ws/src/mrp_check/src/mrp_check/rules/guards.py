# SPDX-License-Identifier: BSD-3-Clause
"""A header of C++ can be included twice: what it defines is passed over the second time.

https://isocpp.github.io/CppCoreGuidelines/CppCoreGuidelines#rs-guards
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources import uses

_GUARD = re.compile(
    r"#\s*pragma\s+once|#\s*ifndef\s+(\w+)\s+#\s*define\s+\1\b|#\s*if\s+!\s*defined"
)
_DEFINES = re.compile(r"\b(?:class|struct|enum)\s+\w+[^;()]*\{")


def _findings(case: Case) -> Iterator[Finding]:
    for file in case.package.of_kind("header"):
        text = uses.code(case.package, file)
        if _DEFINES.search(text) and not _GUARD.search(text):
            yield Finding(
                "compile",
                f"{file} has no include guard: a source that includes it twice, by way of another"
                " header, cannot be compiled.",
                file,
                1,
                WARNING,
                expected="#pragma once, or #ifndef, #define and #endif around it",
                seen=case.package.line(file, 1),
                fix="Write #pragma once into the first line.",
            )


RULE = Rule("files", 62, (), _findings, also=("compile",), only=ANY)
