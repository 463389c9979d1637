"""The package mujoco, of a version that will do.

Raises, when imported: InputError: it is not installed, or too old.
"""

from __future__ import annotations

from tandemlift.core.errors import InputError, extra, install_command

with extra("mujoco", "engine 'mujoco'"):
    import mujoco
if int(mujoco.__version__.split(".")[0]) < 4:
    raise InputError(
        f"engine 'mujoco' needs mujoco 4.0 or newer, whose Runge-Kutta step is of order four for attitudes too; "
        f"{mujoco.__version__} is installed: pip uninstall -y mujoco, then {install_command('mujoco')} (4.0 is three "
        "packages, of which pip removes parts if it replaces 3 by them)"
    )

__all__ = ["mujoco"]
