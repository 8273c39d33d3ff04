# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of several packages share."""

import os
import unittest

# The tests of the tests run one test case of a rostest alone, so that they wait for nothing else: a
# rostest's Python program runs those whose name begins with this.
unittest.TestLoader.testMethodPrefix = os.environ.get("MRP_TEST_CASE", "test")
