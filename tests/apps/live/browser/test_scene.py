"""What is drawn: the threshold's label, and the menu of what is shown."""

import re

import pytest
from chromium import SIZE, panel, rests
from patience import until

pytestmark = pytest.mark.thorough


def test_a_push_below_the_threshold_says_how_much_is_missing_and_the_menu_is_remembered(page, live):
    live.wait(rests, "rest")
    page.click("#show-panel")
    page.locator("#key-force").fill("0.2")
    page.locator("#key-force").press("Enter")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.down("w")
    until(
        lambda: re.fullmatch(r"0\.\d\d of 0\.\d\d N along [xy]", page.text_content(".label.push") or ""),
        "the label of a push that moves nothing",
    )
    page.keyboard.up("w")
    live.wait(lambda seen: not seen["push"].any(), "the end of the push")

    def box():
        return page.get_by_label("person, 1.75 m")

    page.get_by_role("button", name="Show").press("Enter")
    assert page.evaluate("document.activeElement.labels[0].textContent") == "push and moment"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.textContent") == "Show"
    page.keyboard.press("Enter")
    box().check()
    page.reload()
    page.get_by_role("button", name="Show").click()
    assert box().is_checked()


SHARPNESS = "(({ width, clientWidth }) => width / clientWidth)(document.querySelector('#surface canvas'))"


def test_a_video_is_saved_when_other_graphics_are_chosen_which_are_as_sharp_as_the_screen(page, live):
    video = page.locator("#dock button", has_text=re.compile("^(End v|V)ideo$"))
    video.click()
    assert video.text_content() == "End video"
    page.wait_for_timeout(1500.0)  # ms, of a video
    panel(page, "admittance.mass")
    page.locator("#panel summary", has_text="picture").click()
    graphics = page.get_by_role("group", name="Graphics")
    with page.expect_download() as saved:
        graphics.get_by_role("button", name="full").click()
    assert saved.value.suggested_filename.endswith((".webm", ".mp4"))
    assert saved.value.path().stat().st_size > 1000
    assert video.text_content() == "Video"
    screen = page.context.new_cdp_session(page)
    for ratio in (2, 1):  # of a screen that the window is moved to
        screen.send("Emulation.setDeviceMetricsOverride", SIZE | {"deviceScaleFactor": ratio, "mobile": False})
        until(lambda ratio=ratio: page.evaluate(SHARPNESS) == ratio, f"a picture with {ratio} pixels per pixel")
