# SPDX-License-Identifier: BSD-3-Clause
"""What was handed in, and what its files say."""
