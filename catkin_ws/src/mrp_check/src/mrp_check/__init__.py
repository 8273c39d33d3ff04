# SPDX-License-Identifier: BSD-3-Clause
"""The contract checker: runs a student's package, and says what is wrong, where and why."""
