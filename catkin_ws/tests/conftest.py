# SPDX-License-Identifier: BSD-3-Clause
"""What several files of tests begin with."""

import pytest
import run_page


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The folder of the site, built with every warning as an error."""
    folder = tmp_path_factory.mktemp("site")
    run_page.build(folder)
    return folder
