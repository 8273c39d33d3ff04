# SPDX-License-Identifier: BSD-3-Clause
"""What the tools say that build it."""
