"""Packages that only studies need."""

from __future__ import annotations

from types import ModuleType

from tandemlift.common.errors import InputError


def _missing(what: str, name: str) -> InputError:
    return InputError(f"{what} needs the package {name}: pip install 'tandemlift[study]'")


def scipy_special() -> ModuleType:
    """SciPy's special functions.

    Raises:
        InputError: SciPy is not installed.
    """
    try:
        from scipy import special
    except ImportError:
        raise _missing("a normal distribution", "scipy") from None
    return special  # type: ignore[no-any-return]


def scipy_qmc() -> ModuleType:
    """SciPy's quasi-random points.

    Raises:
        InputError: SciPy is not installed.
    """
    try:
        from scipy.stats import qmc
    except ImportError:
        raise _missing("this sampling", "scipy") from None
    return qmc  # type: ignore[no-any-return]


def salib_sample() -> ModuleType:
    """SALib's points for Sobol' indices.

    Raises:
        InputError: SALib is not installed.
    """
    try:
        from SALib.sample import sobol
    except ImportError:
        raise _missing('sampling = "saltelli"', "SALib") from None
    return sobol  # type: ignore[no-any-return]


def parquet() -> ModuleType:
    """PyArrow's module for Parquet files.

    Raises:
        InputError: PyArrow is not installed.
    """
    try:
        from pyarrow import parquet as module
    except ImportError:
        raise _missing("a study", "pyarrow") from None
    return module  # type: ignore[no-any-return]
