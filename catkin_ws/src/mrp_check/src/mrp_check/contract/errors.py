# SPDX-License-Identifier: BSD-3-Clause
"""Errors that stop a check: the text of each is one sentence."""

from typing import Iterable


class CannotCheck(Exception):  # noqa: N818 (it says what happened)
    """Something other than the package keeps the check from being made."""


class NotHere(CannotCheck):
    """This machine lacks what the package needs.

    names: what it lacks, each with the Debian package that has it
    """

    def __init__(self, names: Iterable[str]) -> None:
        self.names = list(names)
        super().__init__(f"Not on this machine, so not checked: {', '.join(self.names)}.")


class PackageError(Exception):
    """The folder cannot be checked."""


class SpecError(Exception):
    """The spec cannot be used; the sentence names the file and the place."""


class ClusterError(Exception):
    """The machines that should check cannot be used, for any submission."""
