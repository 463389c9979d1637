"""The buttons below the picture."""

import numpy as np
import pytest
from chromium import has_said
from patience import until

import tandemlift as tl

FROM_ANOTHER_PAGE = """(message) => {
  const socket = new WebSocket(`ws://${location.host}/ws`);
  socket.onopen = () => socket.send(JSON.stringify({ seq: 1, ...message }));
}"""


def test_time_stands_still_while_it_is_paused_and_passes_as_slowly_as_is_asked(page, live):
    page.keyboard.press("p")
    live.wait_status(lambda status: status["paused"], "a pause")
    page.get_by_role("button", name="Continue").wait_for()  # P does what the button says
    then = live.wait_frames(2)["time"]
    assert live.wait_frames(20)["time"] == then
    page.keyboard.press("p")
    live.wait_status(lambda status: not status["paused"], "time going on")
    page.get_by_label("Speed of the flight").select_option("0.25")
    live.wait_status(lambda status: status["speed"] == 0.25, "a quarter of the pace")
    page.get_by_label("Speed of the flight").select_option("1")
    live.wait_status(lambda status: status["speed"] == 1.0, "its own pace")


def test_a_name_that_is_refused_says_why_in_the_dialog_and_what_another_one_has_flies_again_to_the_last_bit(page, live):
    (live.out / "file").write_text("no folder", "utf-8")
    page.click("#dock span:text-is('Save')")
    page.get_by_role("button", name="Cancel").click()
    assert not page.is_visible("#saving")
    page.click("#dock span:text-is('Save')")
    assert page.get_by_role("dialog", name="Save the flight so far").is_visible()
    reason = page.locator("#saving .reason")
    for name in ("", "a b", "../elsewhere", "x" * 65):
        page.fill("#save-name", name)
        assert not page.is_visible("#saving .reason")
        page.keyboard.press("Enter")
        until(lambda: page.is_visible("#saving .reason"), "a reason")
        assert "must be 1 to 64 letters, digits, '.', '_' or '-'" in reason.text_content()
        assert f'save.name = "{name[:20]}' in reason.text_content()
        assert page.locator("#notices").text_content() == ""
    page.fill("#save-name", "file")
    page.keyboard.press("Enter")
    until(lambda: "file: the name is taken" in reason.text_content(), "a reason")
    page.fill("#save-name", "taken")
    assert not page.is_visible("#saving .reason")
    page.keyboard.press("Enter")
    until(lambda: not page.is_visible("#saving"), "the dialog to close")
    until(lambda: has_said(page, "Saved as"), "a notice")
    folder = live.out / "taken"
    saved, again = tl.Flight.load(folder / "flight.npz"), tl.fly(tl.load_mission(folder / "recorded.toml"))
    for channel in saved.channels:
        np.testing.assert_array_equal(saved[channel], again[channel], channel)


@pytest.mark.thorough
def test_in_the_air_stop_asks_first_and_cancel_and_escape_fly_on(page, live):
    question = page.get_by_role("dialog", name="Stop all rotors?")
    for answer in (page.get_by_role("button", name="Cancel").click, lambda: page.keyboard.press("Escape")):
        page.get_by_role("button", name="Stop").click()
        height = live.look()["position"][2] - live.scene["floor"]
        assert f"The rotors stop and it falls from {height:.1f} m." in question.inner_text()
        answer()
        assert not question.is_visible()
    live.wait_frames(20)
    assert live.status["phase"] in ("guided", "hold")


@pytest.mark.thorough
def test_on_the_ground_stop_asks_nothing_and_a_landing_answers_the_question(page, live):
    page.get_by_role("button", name="Stop").click()
    assert page.locator("#question").is_visible()
    page.evaluate(FROM_ANOTHER_PAGE, {"type": "ask", "what": "land"})
    until(lambda: page.text_content("#mode") == "on the ground", "a landing")
    until(lambda: not page.is_visible("#question"), "no question")
    page.get_by_role("button", name="Stop").click()
    assert not page.is_visible("#question")
    live.wait_status(lambda status: status["phase"] == "stopped", "stopped rotors")
    page.click("#dock button:has-text('Reset')")
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")


def test_it_lands_is_reset_and_the_page_begins_anew(page, live):
    page.get_by_role("button", name="Land").click()
    live.wait_status(lambda status: status["phase"] in ("land", "idle"), "a landing")
    scene = live.scene
    page.click("#dock button:has-text('Reset')")
    live.until(lambda: live.scene is not scene, "a new flight")
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")


@pytest.mark.thorough
def test_a_reset_leaves_nothing_of_the_plots_before_it(page, live):
    tools = page.context.new_cdp_session(page)

    def listeners_after_a_reset():
        scene = live.scene
        page.click("#dock button:has-text('Reset')")
        live.until(lambda: live.scene is not scene, "a new flight")
        until(lambda: page.locator(".plot").count() == 4, "its plots")
        live.wait(lambda seen: seen["time"] > 0.3, "a flight that goes on")
        tools.send("HeapProfiler.collectGarbage")
        return tools.send("Memory.getDOMCounters")["jsEventListeners"]

    page.get_by_role("button", name="\u0394 cm").click()
    before = listeners_after_a_reset()
    after = [listeners_after_a_reset() for _ in range(4)][-1]
    assert after <= before + 130  # the plots of one reset have 62, and the last ones may not be collected yet
    assert page.get_by_role("button", name="\u0394 cm").get_attribute("aria-pressed") == "true"
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")
