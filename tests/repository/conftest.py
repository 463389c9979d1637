"""What tests of the repository share."""

import pytest
from house import python_files


@pytest.fixture(autouse=True, scope="package")
def _syntax_trees():
    """Forget the syntax trees of all files afterwards: they take hundreds of megabytes."""
    yield
    python_files.cache_clear()
