# SPDX-License-Identifier: BSD-3-Clause
"""A module of the package: print_count.py imports it."""

SEVEN = 7
