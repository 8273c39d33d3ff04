# SPDX-License-Identifier: BSD-3-Clause
"""What the build and the run showed."""
