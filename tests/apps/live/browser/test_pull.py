"""The beam pulled by mouse and finger."""

import re

import numpy as np
import pytest
from chromium import grabbed, has_said, middle_of_the_beam, opened, panel, rests, with_still_camera
from patience import until
from scipy.spatial.transform import Rotation


def test_grabbed_and_pulled_the_beam_follows_the_cursor_and_rests_when_it_is_let_go(page, live):
    with_still_camera(page)
    before = live.wait(rests, "rest")
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    page.mouse.move(x + 114, y, steps=20)
    live.wait(lambda s: np.linalg.norm(s["hand_target"] - before["position"]) > 0.3, "a target that moved")
    live.wait_status(lambda status: status["holder"] == "other", "the holder told")

    def follows(seen):
        return np.linalg.norm(seen["position"] - before["position"]) > 0.15 and np.linalg.norm(seen["push"]) > 0.0

    live.wait(follows, "the beam to follow")
    short = 0.3 / live.scene["spring"]["stiffness"] + 0.03  # m along each axis: the threshold, and what noise adds

    def arrived(seen):
        w, *axis = seen["attitude"]
        grip = seen["position"] + Rotation.from_quat([*axis, w]).apply(seen["hand_point"])
        return np.abs(seen["hand_target"] - grip).max() < short

    live.wait(arrived, "the beam to arrive")
    page.mouse.up()
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    live.wait(rests, "rest after release")


@pytest.mark.thorough
def test_one_holds_the_beam_at_a_time_and_a_page_that_is_closed_lets_go(page, live, browser):
    live.wait(rests, "rest")
    other = opened(browser, live.address)
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    held = live.look()["hand_point"]
    until(lambda: re.search("else|other", other.text_content("#meters") or ""), "the holder told")
    u, v = middle_of_the_beam(other)
    other.mouse.move(u + 30, v)
    other.mouse.down()
    other.mouse.move(u + 60, v)
    until(lambda: has_said(other, "another page holds the beam"), "a refusal")
    assert np.allclose(live.look()["hand_point"], held, atol=1e-6)
    other.mouse.up()
    assert live.look()["held"] == 1.0
    other.context.close()
    page.context.close()
    live.wait(lambda seen: seen["held"] == 0.0, "release by a closed page")
    live.wait(rests, "rest")


@pytest.mark.thorough
def test_who_looks_away_lets_go(page, live):
    live.wait(rests, "rest")
    page.mouse.move(*middle_of_the_beam(page))
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    page.evaluate("window.dispatchEvent(new Event('blur'))")
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    page.mouse.up()


@pytest.mark.thorough
def test_the_wheel_moves_the_target_away_from_who_looks(page, live):
    grabbed(page, live)
    before = live.look()["hand_target"]
    page.mouse.wheel(0, -200)
    live.wait(lambda seen: np.linalg.norm(seen["hand_target"] - before) > 0.1, "a target farther away or nearer")
    page.mouse.up()
    live.wait(rests, "rest")


@pytest.mark.thorough
def test_pulled_at_the_centre_of_mass_the_hand_is_there(page, live):
    panel(page, "admittance.mass")  # opens the panel
    page.get_by_text("centre of mass", exact=True).click()
    x, y = grabbed(page, live)
    page.mouse.move(x + 40, y)
    live.wait(lambda seen: np.linalg.norm(seen["push"]) > 0.3, "a pull")
    assert np.abs(live.look()["hand_point"]).max() < 1e-6
    page.mouse.up()
    live.wait(rests, "rest")


@pytest.mark.thorough
def test_a_finger_pulls_as_a_mouse_does(page, live):
    live.wait(rests, "rest")
    x, y = middle_of_the_beam(page)
    touch = page.context.new_cdp_session(page)

    def finger(kind, *points):
        at = [{"x": float(px), "y": float(py)} for px, py in points]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    finger("touchStart", (x, y))
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    for i in range(10):
        finger("touchMove", (x + 5 * i, y))
    live.wait(lambda seen: np.linalg.norm(seen["push"]) > 0.3, "a pull")
    finger("touchEnd")
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    live.wait(rests, "rest")


@pytest.mark.thorough
def test_two_pages_take_turns(page, live, browser):
    live.wait(rests, "rest")
    other = opened(browser, live.address)
    mine, theirs = page.locator("#dock .turns"), other.locator("#dock .turns")
    mine.get_by_role("button", name="Ask for the hand").click()
    until(lambda: "You have the hand." in mine.inner_text(), "the first turn")
    until(lambda: "has the hand." in theirs.inner_text(), "the other page told")
    theirs.get_by_role("button", name="Ask for the hand").click()
    u, v = middle_of_the_beam(other)
    other.mouse.move(u, v)
    other.mouse.down()
    other.mouse.move(u + 30, v)
    until(lambda: has_said(other, "wait for your turn"), "a refusal")
    other.mouse.up()
    mine.get_by_role("button", name="Give it on").click()
    until(lambda: "You have the hand." in theirs.inner_text(), "the second turn")
    u, v = middle_of_the_beam(other)
    other.mouse.move(u, v)
    other.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    other.mouse.up()
    theirs.get_by_role("button", name="Give it back").click()
    until(lambda: "Nobody has the hand." in mine.inner_text(), "nobody's turn")
    other.context.close()


def test_a_hand_that_shakes_pushes_to_and_fro_and_lets_go(page, live):
    live.wait(rests, "rest")
    page.get_by_role("button", name="Shake").click()
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=5)
    pushed = live.wait(lambda seen: np.linalg.norm(seen["push"]) > 0.3, "a push")["push"]
    live.wait(lambda seen: seen["push"] @ pushed < -0.1, "a push the other way")
    live.wait(lambda seen: seen["push"] @ pushed > 0.1, "a push to and fro")
    live.wait_status(lambda status: status["holder"] == "other", "the holder told")
    page.mouse.up()
    live.wait_status(lambda status: status["holder"] == "none", "release")
    live.wait(rests, "rest")
    page.get_by_role("button", name="Push", exact=True).click()


@pytest.mark.thorough
def test_a_tap_pushes_away_from_who_looks_and_holds_nothing(page, live):
    live.wait(rests, "rest")
    page.get_by_role("button", name="Tap").click()
    here = live.look()["position"]
    page.mouse.click(*middle_of_the_beam(page))
    live.wait(lambda seen: np.linalg.norm(seen["position"] - here) > 0.002, "a beam that moved")
    assert live.status["holder"] == "none"
    live.wait(rests, "rest")
