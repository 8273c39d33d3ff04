# SPDX-License-Identifier: BSD-3-Clause
"""What only a contract asks for."""
