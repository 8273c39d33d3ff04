# SPDX-License-Identifier: BSD-3-Clause
"""Adapters: what other people's tools say of a package, in our words. Each file is one table."""
