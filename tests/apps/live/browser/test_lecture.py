"""A lecture at a server: its script sets, pauses and pushes; and a ghost that flies in the server."""

import pytest
from chromium import dropped, panel
from patience import until

pytestmark = pytest.mark.thorough

SCRIPT = """
[[steps]]
text = "Still."
settings.admittance.damping = 4
[[steps]]
text = "Pushed, and it stands."
push = { force = [0, 1.5, 0], duration = 60 }
[[steps]]
text = "Paused."
pause = true
"""


@pytest.fixture
def lecture(page, live):
    """The page at the first step of the script; all is as before afterwards."""
    dropped(page, SCRIPT)
    until(lambda: page.locator("#lecture").is_visible(), "the lecture")
    yield page
    page.keyboard.press("t")
    panel(page, "admittance.damping")
    page.get_by_role("button", name="Restore all values").click()
    live.wait_status(lambda s: not s["paused"], "a flight that goes on")


def test_a_script_sets_pushes_and_pauses_a_flight_of_a_server(lecture, live):
    entry = lecture.locator("[data-key='admittance.damping'] input[type=number]").first
    live.until(lambda: entry.input_value() == "4", "a setting")
    lecture.keyboard.press("PageDown")
    live.wait(lambda seen: abs(seen["push"][1] - 1.5) < 0.02, "the push")
    lecture.keyboard.press("PageDown")
    live.wait_status(lambda s: s["paused"], "a pause")
    lecture.keyboard.press("PageUp")
    live.wait(lambda seen: abs(seen["push"]).max() < 0.02, "no push on the way back")


def test_a_ghost_flies_in_the_server_with_its_settings_and_ends(page, live):
    entry = panel(page, "admittance.damping").locator("input[type=number]").first
    first = entry.input_value()
    page.get_by_label("Compare").select_option(index=1)
    until(lambda: "same settings" in page.text_content("#comparison"), "a ghost")
    entry.fill("7")
    entry.press("Enter")
    until(lambda: f"damping {first}, now: 7" in page.text_content("#comparison"), "what differs")
    page.locator("#comparison").get_by_role("button", name="Swap").click()
    until(lambda: "damping 7" in page.text_content("#comparison"), "the other way round")
    assert entry.input_value() == first
    page.locator("#comparison").get_by_role("button", name="End").click()
    until(lambda: page.locator("#comparison").is_hidden(), "a flight by itself")
