# SPDX-License-Identifier: BSD-3-Clause
"""One browser of each kind for all tests, and the site at both of its addresses."""

import pytest
from browser import Browser
from built_site import SITE, served
from firefox import Firefox

pytest_plugins = ("mrp_testing.guard",)


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.fixture(scope="session")
def firefox(tmp_path_factory):
    with Firefox(tmp_path_factory.mktemp("firefox")) as started:
        yield started


@pytest.fixture(scope="session")
def addresses():
    with served() as address:
        yield {"file": SITE.as_uri() + "/", "served": address}
