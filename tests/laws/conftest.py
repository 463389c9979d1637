"""Array libraries that the tests of the laws need, each skipped where it is not installed."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def jax():
    """JAX in double precision."""
    module = pytest.importorskip("jax")
    module.config.update("jax_enable_x64", True)
    return module


@pytest.fixture(scope="session")
def casadi():
    """CasADi."""
    return pytest.importorskip("casadi")
