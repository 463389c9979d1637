"""A browser, a live flight, and a page that shows it."""

import pytest
from patience import until


@pytest.fixture(scope="package")
def live(tmp_path_factory):
    from chromium import Live

    one = Live(tmp_path_factory.mktemp("live"))
    try:
        yield one
    finally:
        one.close()


@pytest.fixture(scope="package")
def browser():
    from chromium import launched

    with launched() as one:
        yield one


@pytest.fixture
def page(browser, live):
    from chromium import opened

    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    one = opened(browser, live.address)
    until(lambda: one.text_content("#mode") in ("guided", "holding"), "a status on the page")
    yield one
    assert one.wrong == []
    one.context.close()
