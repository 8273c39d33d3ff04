# SPDX-License-Identifier: BSD-3-Clause
"""What the files of the package say."""
