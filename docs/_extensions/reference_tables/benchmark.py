"""The tables of the benchmark's baselines, as the package has them."""

from tandemlift.analysis.studies.benchmark import shipped_tables
from tandemlift.analysis.studies.design.benchmark_columns import lines_of


def controllers() -> str:
    """Of the controllers."""
    return "\n".join(lines_of("controllers", shipped_tables()["controllers"]))


def observers() -> str:
    """Of the observers of the external wrench."""
    return "\n".join(lines_of("observers", shipped_tables()["observers"]))


def policies() -> str:
    """Of the policies."""
    return "\n".join(lines_of("policies", shipped_tables()["policies"]))
