# SPDX-License-Identifier: BSD-3-Clause
"""A package without a contract that works, though much of it looks broken: it has no error."""

import pathlib

import pytest
from mrp_check.contract.finding import ERROR, WARNING
from mrp_check.package.package import Package
from mrp_check.verdict import check

pytestmark = pytest.mark.slow

VALID = pathlib.Path(__file__).with_name("valid_nodes")


def test_what_only_looks_broken_has_no_error():
    report = check.check(Package(VALID), None, timeout=300)
    found = [one for one in report.findings if one.severity in (ERROR, WARNING)]
    assert not [one.message for one in found if one.severity == ERROR]
    assert len(found) <= 2, [one.message for one in found]
