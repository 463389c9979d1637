"""What all tests share: programs that need root, and hypothesis without deadlines on a shared machine."""

import os
import shutil

import hypothesis
import pytest

hypothesis.settings.register_profile("tandemlift", deadline=None, derandomize=True)
hypothesis.settings.load_profile("tandemlift")


@pytest.fixture(scope="session")
def program():
    """Path of a program that may have to be installed as root; without it the test skips by its name.

    With TANDEMLIFT_REQUIRE_ALL=1, as in `.ci/run`, it fails instead.
    """

    def find(name: str) -> str:
        path = shutil.which(name)
        if path is None and os.environ.get("TANDEMLIFT_REQUIRE_ALL") == "1":
            pytest.fail(f"{name} is not installed, and TANDEMLIFT_REQUIRE_ALL is 1")
        if path is None:
            pytest.skip(f"{name} is not installed")
        return path

    return find
