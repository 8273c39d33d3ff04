# SPDX-License-Identifier: BSD-3-Clause
"""The files beside the Python code: specs, schemas, and the workspace's defects."""

import pathlib

_HERE = pathlib.Path(__file__).resolve().parent


def folder(name):
    """Return the folder `name` of the package or of its workspace, or where it is installed."""
    installed = _HERE.parents[3] / "share" / "mrp_check" / name
    in_sources = (_HERE.parents[1] / name, _HERE.parents[3] / name)
    return next((folder for folder in in_sources if folder.is_dir()), installed)
