"""A lecture at a server: its script sets, pauses and pushes; a ghost needs a page without one, and the page says so."""

import pytest
from chromium import dropped, panel
from patience import until

SCRIPT = """
[[steps]]
text = "Still."
settings.admittance.damping = 4
[[steps]]
text = "Pushed, and it stands."
push = { force = [0, 1.5, 0], duration = 20 }
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


def test_a_ghost_is_refused_with_the_reason_in_menu_and_script(page):
    panel(page, "admittance.mass")
    entry = page.get_by_label("Compare").locator("option[disabled]")
    assert entry.inner_text() == "not here: only a page without a server (tandemlift page) flies two"
    dropped(page, SCRIPT.replace("pause = true", 'ghost = "keep"'))
    until(lambda: page.locator("#question").is_visible(), "the refusal")
    wanted = 'step 3: ghost = "keep": must be left out here: only a page without a server flies two'
    assert wanted in page.inner_text("#question")
    page.get_by_role("button", name="Close").click()
