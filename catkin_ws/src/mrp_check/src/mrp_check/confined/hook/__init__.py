# SPDX-License-Identifier: BSD-3-Clause
"""A package, so that it is installed; Python nodes get the folder itself in their PYTHONPATH."""
