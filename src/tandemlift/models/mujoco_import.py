"""The package mujoco, of a version that will do.

Raises, when imported: InputError: it is not installed, or too old.
"""

from __future__ import annotations

from tandemlift.common.errors import InputError

try:
    import mujoco
except ModuleNotFoundError as error:
    if error.name != "mujoco":
        raise
    raise InputError("engine 'mujoco' needs the package mujoco: pip install 'tandemlift[mujoco]'") from None
if int(mujoco.__version__.split(".")[0]) < 4:
    raise InputError(
        f"engine 'mujoco' needs mujoco 4.0 or newer, whose Runge-Kutta step is of order four for attitudes too; "
        f"{mujoco.__version__} is installed: pip install --upgrade 'tandemlift[mujoco]'"
    )

__all__ = ["mujoco"]
