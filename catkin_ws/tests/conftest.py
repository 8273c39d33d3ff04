# SPDX-License-Identifier: BSD-3-Clause
"""What several files of tests begin with."""

import socket

import pytest
import run_page
from doctor_patient import Patient


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The folder of the site, built with every warning as an error."""
    folder = tmp_path_factory.mktemp("site")
    run_page.build(folder)
    return folder


@pytest.fixture
def patient(tmp_path):
    with socket.socket() as reserved:
        # A port that is bound, but not listened to, is given to no other program that asks for
        # any port; but the doctor and a master, who ask for this one, may have it.
        reserved.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        reserved.bind(("localhost", 0))
        yield Patient(tmp_path, reserved.getsockname()[1])
