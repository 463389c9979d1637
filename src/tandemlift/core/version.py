"""The versions of the package and of the packages that a flight uses."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import metadata

__version__ = "0.2.0"


@cache
def versions(engine: str) -> Mapping[str, str]:
    """Versions of the packages that a flight in an engine uses."""
    packages = ("llvmlite", "numpy", *(["mujoco"] if engine == "mujoco" else []))
    return {"tandemlift": __version__, **{name: metadata.version(name) for name in packages}}
