"""What the page says where a request has no effect, while the sensors are tared, and where a flight has ended."""

import re
from itertools import combinations

import pytest
from chromium import grabbed, has_said, opened, stopped
from patience import until

pytestmark = pytest.mark.thorough

TARED, BAD = '"tare_left_s":1.4', '"findings":[{"kind":"touched","time":7.2,"text":"the beam touched a wall"}]'
OVER = "#views, #hint, #notices p, #refusal, #dock .strip"
BOXES = """(of) => [...document.querySelectorAll(of)]
  .filter((e) => e.checkVisibility())
  .map((e) => [e.id || e.textContent, e.getBoundingClientRect()])
  .map(([name, { left, top, right, bottom }]) => [name, left, top, right, bottom])"""


def told(page, place):
    return page.text_content(place) if page.is_visible(place) else ""


def covered(boxes):
    """The pairs of boxes of which one covers the other."""
    return [
        (name, other)
        for (name, *a), (other, *b) in combinations(boxes, 2)
        if min(a[2], b[2]) > max(a[0], b[0]) and min(a[3], b[3]) > max(a[1], b[1])
    ]


def test_a_lift_in_the_air_says_why_it_is_refused_where_one_points_at_it_and_when_it_is_pressed(page, live):
    lift = page.get_by_role("button", name="Lift")
    until(lambda: "the vehicle is in the air already" in lift.get_attribute("title"), "a reason for whoever asks")
    assert not page.is_visible("#refusal")
    lift.hover()
    until(lambda: "the vehicle is in the air already" in told(page, "#refusal:not(.asked)"), "the reason")
    page.hover("#views")
    until(lambda: not page.is_visible("#refusal"), "no reason")
    lift.click(force=True)  # it is marked as disabled
    until(lambda: "the vehicle is in the air already" in told(page, "#refusal.asked"), "a reason")
    refused = page.locator("#dock [aria-disabled=true]").first
    button, note = refused.bounding_box(), page.locator("#refusal").bounding_box()
    assert note["y"] + note["height"] <= button["y"]
    assert button["y"] - note["y"] < 120.0
    assert "in the air already" not in page.text_content("#notices")
    page.click("#refusal")
    until(lambda: not page.is_visible("#refusal"), "no reason")


def test_a_push_that_is_not_followed_says_so_at_the_hand(page, live):
    page.get_by_role("button", name="Lift").click(force=True)
    until(lambda: told(page, "#refusal.asked"), "a reason")
    page.get_by_role("button", name="Follows me").click()
    live.wait_status(lambda status: not status["enabled"], "a pilot that does not listen")
    x, y = grabbed(page, live)
    until(lambda: not page.is_visible("#refusal"), "room for what is said at the hand")
    page.mouse.move(x + 60, y, steps=4)
    until(
        lambda: "told not to follow pushes. Let it follow again." in told(page, ".label.refusal"),
        "a reason at the hand",
    )
    box, picture = page.locator(".label.refusal").bounding_box(), page.locator("#view").bounding_box()
    assert box["x"] + box["width"] <= picture["x"] + picture["width"]
    until(lambda: page.is_visible(".label.moment"), "the moment of the push")
    assert covered(page.evaluate(BOXES, ".label")) == []
    page.mouse.up()
    until(lambda: told(page, ".label.refusal") == "", "nothing more to say")
    page.get_by_role("button", name="Does not follow").click()
    live.wait_status(lambda status: status["enabled"], "a pilot that listens")


def test_a_crash_is_marked_told_and_left_by_beginning_again(page, live):
    stopped(page)  # it falls from a metre
    live.wait_status(lambda status: status["phase"] in ("stopped", "crashed"), "stopped rotors")
    until(lambda: "The vehicle has crashed" in told(page, "#ended"), "a crash")
    assert live.status["ending"]["text"] in told(page, "#ended")
    assert re.search(r": hit the floor: \d+(\.\d+)? of 7 N s$", live.status["ending"]["text"])
    until(lambda: "crashed here" in told(page, ".label.ending"), "a mark where it crashed")
    assert told(page, "#mode") == "crashed"
    page.get_by_role("button", name="Lift").click(force=True)
    until(lambda: has_said(page, "Begin the flight again."), "a reason")
    page.get_by_role("button", name="Begin again").click()
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")
    until(lambda: not page.is_visible("#ended"), "no crash")


def test_a_tare_is_counted_down_and_no_text_over_the_picture_covers_another(browser, live):
    def tared(socket):
        server = socket.connect_to_server()
        server.on_message(
            lambda said: socket.send(
                said
                if isinstance(said, bytes)
                else re.sub(r'"tare_left_s":[\d.]+', TARED, said).replace('"findings":[]', BAD)
            )
        )

    def prepare(one):
        one.route_web_socket("**/ws", tared)
        one.add_init_script(
            "const wait = setTimeout; window.setTimeout = (f, ms, ...more) => wait(f, 1e5 * ms, ...more)"
        )

    page = opened(browser, live.address, prepare)
    for size in ((1920, 1080), (1280, 800), (800, 450), (390, 844)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        until(lambda: told(page, "#hint") == "Zeroing the force sensors: do not touch for 1.4 s", "the countdown")
        page.evaluate("document.querySelector('#hint').textContent += ', and nothing that is as long as this'")
        boxes = page.evaluate(BOXES, OVER)
        assert any("touched" in name for name, *_ in boxes) or size != (1920, 1080)  # it stays for 6 s
        assert [name for name, left, _, right, _ in boxes if left < 0.0 or right > size[0]] == [], size
        assert covered(boxes) == [], size
    page.context.close()
