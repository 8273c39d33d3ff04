# SPDX-License-Identifier: BSD-3-Clause
"""What its code says, without being run."""
