"""A challenge on a phone: the hand moves level, what is not ranked stands still, and nothing is cut."""

import pytest
from chromium import opened, panel, seconds_flown
from patience import until

from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files

pytestmark = pytest.mark.thorough

UPRIGHT, LYING = {"width": 390, "height": 844}, {"width": 844, "height": 390}
TOUCH = {"has_touch": True, "is_mobile": True}
CUT = """() => [...document.querySelectorAll("#dock button span, #dock dd")]
  .filter((one) => one.checkVisibility())
  .map((one) => [one.textContent, one.getBoundingClientRect(), document.querySelector("#view").getBoundingClientRect()])
  .filter(([, one, view]) => one.bottom > view.bottom || one.top < view.top || one.right > view.right || one.left < 0)
  .map(([text]) => text)"""


@pytest.fixture(scope="module")
def address(corridor, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "corridor.html"
    file.write_text(pages.offline_html([corridor], page_files()), "utf-8")
    return file.as_uri()


def plane(page):
    """The plane of the hand."""
    return page.locator("[aria-label='Plane of the hand'] [aria-pressed=true]").text_content()


def clock(page):
    return page.text_content("#challenge .time dd"), page.text_content("#challenge .score dd")


def test_on_a_phone_the_hand_moves_level_and_a_run_that_is_not_ranked_stands_still(browser, address):
    page = opened(browser, address, **TOUCH)
    page.set_viewport_size(UPRIGHT)
    assert plane(page) == "facing me"
    page.get_by_role("button", name="Challenge").tap()
    assert plane(page) == "level"
    assert "held by" not in page.inner_text("#meters")
    until(lambda: page.text_content("#mode") == "follows pushes", "a flight at its height")
    page.keyboard.down("e")  # over the walls
    until(lambda: "Not ranked: left the corridor" in page.inner_text("#challenge"), "the end of the run")
    page.keyboard.up("e")
    stood, flown = clock(page), seconds_flown(page)
    until(lambda: seconds_flown(page) > flown + 1.0, "a second more")
    assert clock(page) == stood
    page.locator("#challenge").get_by_role("button", name="New run").tap()
    until(lambda: clock(page) == ("–", "–"), "a new run")
    assert page.wrong == []
    page.context.close()


def test_ghost_and_challenge_share_a_line_on_a_phone_that_lies_and_no_word_is_cut(browser, address):
    page = opened(browser, address, lambda one: one.set_viewport_size(LYING), **TOUCH)
    until(lambda: seconds_flown(page) > 1.0, "a flight")
    assert page.is_hidden("#plots")
    page.get_by_role("button", name="Challenge").tap()
    panel(page, "admittance.damping")
    page.get_by_label("Compare").select_option(index=1)
    page.click("#show-panel")
    until(lambda: page.is_visible("#comparison"), "a ghost")
    for _ in range(2):  # without plots, and with them
        places = [page.locator(f"{one} .strip").bounding_box() for one in ("#comparison", "#challenge")]
        assert places[0]["y"] < places[1]["y"] + places[1]["height"]
        assert places[1]["y"] < places[0]["y"] + places[0]["height"]
        assert places[0]["x"] + places[0]["width"] <= places[1]["x"]
        assert page.evaluate(CUT) == []
        page.click("#show-plots")
    assert page.wrong == []
    page.context.close()
