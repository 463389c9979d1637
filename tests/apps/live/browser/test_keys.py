"""The beam pushed by keys and gamepad."""

import numpy as np
import pytest
from chromium import opened, panel, rests
from patience import until

pytestmark = pytest.mark.thorough


def test_a_key_pushes_with_the_force_that_is_stated(page, live):
    live.wait(rests, "rest")
    page.locator("#surface canvas").hover()
    page.keyboard.down("ArrowUp")
    live.wait(lambda seen: abs(np.linalg.norm(seen["push"]) - 3.0) < 0.05, "a push of 3 N")
    page.keyboard.up("ArrowUp")
    live.wait(lambda seen: np.linalg.norm(seen["push"]) < 0.01, "no push")
    live.wait(rests, "rest")


def test_keys_push_after_a_checkbox_was_used_and_beside_those_of_a_slider(page, live):
    live.wait(rests, "rest")
    page.get_by_role("button", name="Show").click()
    page.get_by_label("person, 1.75 m").click()
    page.keyboard.down("ArrowUp")
    live.wait(lambda seen: abs(np.linalg.norm(seen["push"]) - 3.0) < 0.05, "a push of 3 N")
    page.keyboard.up("ArrowUp")
    live.wait(lambda seen: np.linalg.norm(seen["push"]) < 0.01, "no push")
    panel(page, "admittance.mass").locator("input[type=range]").first.focus()
    page.keyboard.down("ArrowRight")
    page.keyboard.down("e")
    push = live.wait(lambda seen: np.linalg.norm(seen["push"]) > 2.95, "a push of another key")["push"]
    assert np.abs(push - [0.0, 0.0, 3.0]).max() < 0.05
    page.keyboard.up("e")
    page.keyboard.up("ArrowRight")
    page.get_by_text("Restore all values").click()
    live.wait(rests, "rest")


GAMEPAD = """
window.pad = { connected: true, axes: [0, 0, 0, 0], buttons: [] };
navigator.getGamepads = () => [null, window.pad];
"""


def test_a_gamepad_pushes_beyond_its_dead_zone_and_lets_go_when_it_is_unplugged(browser, live):
    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    live.wait(rests, "rest")
    page = opened(browser, live.address, lambda one: one.add_init_script(GAMEPAD))
    until(lambda: page.text_content("#mode") in ("follows pushes", "holding"), "a status on the page")
    page.get_by_role("button", name="Settings").click()
    page.get_by_text("world axes", exact=True).click()
    page.locator("#surface canvas").hover()

    def stick(*axes):
        page.evaluate("axes => (window.pad.axes = axes)", axes)

    def pushed(*force):
        return live.wait(lambda seen: np.abs(seen["push"] - force).max() < 0.05, f"a push of {force} N")

    stick(0.14, -0.14, 0.0, 0.14)  # within the dead zone
    for _ in range(20):
        page.evaluate("new Promise(requestAnimationFrame)")  # the page looks at the stick
    assert np.abs(live.wait_frames(20)["push"]).max() < 0.01
    stick(0.0, -1.0, 0.0, 0.0)
    pushed(3.0, 0.0, 0.0)
    stick(0.575, 0.0, 0.0, 0.0)  # half of what is beyond the dead zone
    pushed(0.0, -1.5, 0.0)
    stick(0.0, 0.0, 0.0, -1.0)
    pushed(0.0, 0.0, 3.0)
    page.evaluate("window.pad.connected = false")
    pushed(0.0, 0.0, 0.0)
    page.evaluate("window.pad.connected = true")
    pushed(0.0, 0.0, 3.0)
    page.evaluate("window.pad = null")
    pushed(0.0, 0.0, 0.0)
    assert page.wrong == []
    page.context.close()
    live.wait(rests, "rest")


def test_the_keys_push_no_harder_than_the_hand_of_the_mission(page, live):
    most = live.scene["spring"]["max_force"]
    panel(page, "admittance.mass")  # opens the panel
    entry = page.locator("#key-force")
    entry.fill("50")
    entry.press("Enter")
    until(lambda: float(entry.input_value()) == most, "the most that the hand can")
