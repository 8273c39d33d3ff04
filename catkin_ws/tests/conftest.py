# SPDX-License-Identifier: BSD-3-Clause
"""What several files of tests begin with."""

import pytest
import run_page
from doctor_patient import Patient
from mrp_testing.ports import free_port


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The folder of the site, built with every warning as an error."""
    folder = tmp_path_factory.mktemp("site")
    run_page.build(folder)
    return folder


@pytest.fixture
def patient(tmp_path):
    return Patient(tmp_path, free_port())
