"""A browser, a live flight, and a page that shows it."""

import pytest
from patience import until

import tandemlift as tl
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.replay import replay_html


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


@pytest.fixture(scope="package")
def replay(tmp_path_factory):
    """The address of a page that shows `one-push` again."""
    html = tmp_path_factory.mktemp("replay") / "replay.html"
    html.write_text(replay_html(tl.fly(tl.load_mission("one-push")), page_files()), "utf-8")
    return html.as_uri()


@pytest.fixture
def page(browser, live):
    from chromium import opened

    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    one = opened(browser, live.address)
    until(lambda: one.text_content("#mode") in ("follows pushes", "holding"), "a status on the page")
    yield one
    assert one.wrong == []
    one.context.close()
