# SPDX-License-Identifier: BSD-3-Clause
"""Why a check cannot be made: the text of each of these errors is one sentence."""


class CannotCheck(Exception):  # noqa: N818 (it says what happened)
    """Something other than the package keeps the check from being made."""


class PackageError(Exception):
    """The folder cannot be checked."""


class SpecError(Exception):
    """The spec cannot be used; the sentence names the file and the place."""


class ClusterError(Exception):
    """The machines that should check cannot be used, for any submission."""
