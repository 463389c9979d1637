"""A small study, flown once for all tests of this folder, which leave it as it is."""

import pytest
from study_runs import TWELVE, fly


@pytest.fixture(scope="session")
def flown_twelve(tmp_path_factory):
    """The folder of a study of twelve chunks."""
    folder = tmp_path_factory.mktemp("studies") / "twelve"
    assert fly(TWELVE, folder, threads=2) == 12
    return folder
