# SPDX-License-Identifier: BSD-3-Clause
"""Check a package, and weigh what was found."""
