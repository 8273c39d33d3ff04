# SPDX-License-Identifier: BSD-3-Clause
"""These tests use what the tutorial package's own tests are made of."""

import pathlib
import sys

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(WORKSPACE / "src" / "mrp" / "test"))
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))
