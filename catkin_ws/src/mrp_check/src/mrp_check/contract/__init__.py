# SPDX-License-Identifier: BSD-3-Clause
"""The contract, and the types of a report."""
