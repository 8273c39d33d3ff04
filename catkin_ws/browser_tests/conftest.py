# SPDX-License-Identifier: BSD-3-Clause
"""One browser for all tests, and the site at both of its addresses: as files, and served."""

import pytest
from browser import Browser
from built_site import SITE, served


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as one:
        yield one


@pytest.fixture(scope="session")
def addresses():
    with served() as address:
        yield {"file": SITE.as_uri() + "/", "served": address}
