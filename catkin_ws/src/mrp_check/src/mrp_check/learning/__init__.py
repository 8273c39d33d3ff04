# SPDX-License-Identifier: BSD-3-Clause
"""The exercises: what each is, what is watched while somebody works at one, and how it is shown."""
