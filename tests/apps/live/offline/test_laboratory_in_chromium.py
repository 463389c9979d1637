"""The page as a laboratory, used by a real mouse and real fingers: plots, timeline, rewinding, undo."""

import numpy as np
import pytest
from chromium import aloft, opened, panel, paused, pushed, resized, save, seconds_flown
from own_flight import check_flies_again
from patience import until

import tandemlift as tl

pytestmark = pytest.mark.thorough

NOW = "#time button[title^='The last seconds']:not([hidden])"  # without its word on a phone
WIDE, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


def area(page, plot=0):
    box = page.locator(".plot .u-over").nth(plot).bounding_box()
    return box["x"], box["y"] + box["height"] / 2, box["width"]


def shown(page):
    """The times at which all plots show values."""
    texts = page.locator(".plot .cursor:not([hidden]) .values > b").all_text_contents()
    return [float(text.removesuffix(" s")) for text in texts]


def test_a_drag_zooms_all_plots_which_show_values_at_one_moment_and_come_back(browser, address):
    page = aloft(browser, address, WIDE, 4.0)
    page.keyboard.press("p")  # its plots stand still
    until(lambda: paused(page), "a pause")
    x, y, width = area(page)
    page.mouse.move(x + 0.95 * width, y)
    page.mouse.down()
    for place in (0.96, 0.97, 0.98, 0.99, 0.99):
        page.mouse.move(x + place * width, y)
    page.mouse.up()  # a second, of twenty

    def pointed():
        page.mouse.move(x + 0.1 * width, y + 1)  # a mouse moves on after a drag has ended
        page.mouse.move(x + 0.1 * width, y)
        return shown(page) if len(shown(page)) == 4 else None

    left = until(pointed, "values in all plots")
    page.mouse.move(x + 0.9 * width, y)
    until(lambda: shown(page) and shown(page)[0] > left[0] + 0.3, "another moment")
    right = shown(page)
    assert len(set(right)) == 1
    assert right[0] - left[0] < 1.6
    page.mouse.dblclick(x + 0.5 * width, y)
    page.mouse.move(x + 0.02 * width, y + 1)
    until(lambda: not shown(page), "the last 20 s, in whose first the flight had not begun")
    assert page.wrong == []
    page.context.close()


def test_fingers_spread_time_and_a_tapped_mark_is_the_moment(browser, address):
    page = opened(browser, address, has_touch=True, is_mobile=True)
    resized(page, PHONE)
    if page.get_attribute("#show-panel", "aria-pressed") == "true":
        page.click("#show-panel")
    until(lambda: seconds_flown(page) > 6.0, "a flight")
    resized(page, PHONE)
    x, y, width = area(page)
    touch = page.context.new_cdp_session(page)

    def fingers(kind, *places):
        at = [{"x": x + place * width, "y": y, "id": i} for i, place in enumerate(places)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    assert page.locator(NOW).count() == 0
    fingers("touchStart", 0.8, 0.9)
    for spread in (0.1, 0.2, 0.3):
        fingers("touchMove", 0.8 - spread, 0.9)
    fingers("touchEnd")
    until(lambda: page.locator(NOW).count() == 1, "a stretch of time")
    page.locator(NOW).tap()
    pushed(page)
    mark = until(lambda: page.locator(".mark.push").first if page.locator(".mark.push").count() else None, "a mark")
    until(lambda: "push of" in (mark.get_attribute("aria-label") or ""), "its words")
    page.keyboard.press("p")  # marks stand still
    until(lambda: paused(page), "a pause")
    place = mark.bounding_box()
    page.touchscreen.tap(place["x"] + place["width"] / 2 + 4, place["y"] + place["height"])
    until(lambda: "push of" in page.locator(".timeline .words").text_content(), "the words of a mark")
    began = float(mark.get_attribute("aria-label").split(" s:")[0])
    until(lambda: shown(page) and abs(shown(page)[0] - began) < 0.06, "values where the push began")
    assert page.wrong == []
    page.context.close()


def test_who_tries_again_pushes_anew_and_saves_the_new_flight(browser, address, tmp_path):
    page = aloft(browser, address, WIDE)
    pushed(page)
    entry = panel(page, "person.stiffness").locator("input[type=number]")
    first = entry.input_value()
    entry.fill("9")
    entry.press("Enter")
    until(lambda: page.locator(".mark.setting").count() == 1, "a mark of what was set")
    entry.press("Control+z")
    until(lambda: entry.input_value() == first, "the setting as it was")
    page.get_by_role("button", name="Redo").click()
    until(lambda: entry.input_value() == "9", "the setting again")

    def words():
        page.locator(".mark.push").blur()
        page.locator(".mark.push").focus()
        return page.locator(".timeline .words").text_content()

    until(lambda: "push of" in words(), "the words of a mark")
    page.keyboard.press("Enter")
    began = float(page.locator(".timeline .words").inner_text().split(" s:")[0])
    page.keyboard.press("r")
    until(lambda: page.get_by_role("button", name="Continue").count() == 1, "a flight that stands")
    until(lambda: abs(seconds_flown(page) - began) < 0.16, "the moment of the push, to a tenth")
    assert page.locator(".mark").count() <= 1  # the push of which this is the beginning
    assert entry.input_value() == first
    page.keyboard.press("p")
    until(lambda: not paused(page), "a flight that goes on")
    pushed(page, key="KeyA")
    page.keyboard.press("p")
    until(lambda: paused(page), "a pause")
    save(page, tmp_path)
    assert page.wrong == []
    page.context.close()
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))
    mission = tl.load_mission(tmp_path / "recorded.toml")
    assert not mission.changes
    assert mission.mission.duration < began + 20.0
