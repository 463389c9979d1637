"""What the page says where a request has no effect, and where a flight has ended."""

from chromium import grabbed
from patience import until


def told(page, place):
    return page.text_content(place) if page.is_visible(place) else ""


def test_a_lift_in_the_air_is_refused_beside_its_button_until_it_is_pressed_away(page, live):
    page.get_by_role("button", name="Lift").click()
    until(lambda: "the vehicle is in the air already" in told(page, "#refusal"), "a reason")
    button, note = page.locator("#dock button.refused").first.bounding_box(), page.locator("#refusal").bounding_box()
    assert note["y"] + note["height"] <= button["y"]
    assert button["y"] - note["y"] < 120.0
    assert page.text_content("#notices") == ""
    page.click("#refusal")
    assert not page.is_visible("#refusal")


def test_a_push_that_is_not_followed_says_so_at_the_hand(page, live):
    page.get_by_role("button", name="Enabled").click()
    live.wait_status(lambda status: not status["enabled"], "a pilot that does not listen")
    x, y = grabbed(page, live)
    page.mouse.move(x + 60, y, steps=4)
    until(lambda: "told not to follow pushes. Enable it." in told(page, ".label.refusal"), "a reason at the hand")
    box, picture = page.locator(".label.refusal").bounding_box(), page.locator("#view").bounding_box()
    assert box["x"] + box["width"] <= picture["x"] + picture["width"]
    page.mouse.up()
    until(lambda: told(page, ".label.refusal") == "", "nothing more to say")
    page.get_by_role("button", name="Disabled").click()
    live.wait_status(lambda status: status["enabled"], "a pilot that listens")


def test_a_crash_is_marked_told_and_left_by_beginning_again(page, live):
    page.get_by_role("button", name="Stop").click()  # it falls from a metre
    until(lambda: "The vehicle has crashed" in told(page, "#ended"), "a crash")
    assert live.status["ending"]["text"] in told(page, "#ended")
    until(lambda: "crashed here" in told(page, ".label.ending"), "a mark where it crashed")
    assert told(page, "#mode") == "crashed"
    page.get_by_role("button", name="Lift").click()
    until(lambda: "Begin the flight again." in told(page, "#refusal"), "a reason")
    page.get_by_role("button", name="Begin again").click()
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")
    until(lambda: not page.is_visible("#ended"), "no crash")
