# SPDX-License-Identifier: BSD-3-Clause
"""What is known of the package under check."""
