"""Parameters and rotors in the panel."""

import pytest
from chromium import opened, panel
from patience import until

pytestmark = pytest.mark.thorough


def test_a_refused_setting_says_why_and_shows_what_it_was(page, live):
    box = panel(page, "admittance.mass")
    entry = box.locator("input[type=number]").first
    before = entry.input_value()
    entry.fill("9999")
    entry.press("Enter")
    until(lambda: "must be from 0.3 to 20" in box.locator(".reason").text_content(), "a reason")
    assert entry.input_value() == before


def test_what_is_no_number_is_named_and_the_value_stays(page, live):
    box = panel(page, "admittance.mass")
    entry = box.locator("input[type=number]").first
    before = entry.input_value()
    entry.select_text()
    entry.press_sequentially("--")
    entry.press("Enter")
    until(lambda: "is no finite number" in box.locator(".reason").text_content(), "a reason")
    assert entry.input_value() == before


def test_a_dead_rotor_is_marked_on_every_page(browser, live):
    def told(socket):
        server = socket.connect_to_server()
        server.on_message(
            lambda told: socket.send(
                told if isinstance(told, bytes) else told.replace('"failed_rotors":[]', '"failed_rotors":[2]')
            )
        )

    page = opened(browser, live.address, lambda one: one.route_web_socket("**/ws", told))
    until(lambda: page.locator("#panel g.failed").count() == 1, "a rotor that is marked")
    assert page.locator("#panel g.failed").get_attribute("aria-label") == "Rotor 3, stopped"
    page.context.close()


def test_settings_that_are_entered_change_the_flight_and_come_back_each_and_all(page, live):
    def enter(key, value):
        entry = panel(page, key).locator("input[type=number]").first
        entry.fill(value)
        entry.press("Enter")
        until(lambda: "altered" in panel(page, key).get_attribute("class"), "a mark of what is altered")

    enter("wind.velocity", "2")
    live.wait(lambda seen: abs(seen["wind"][0] - 2.0) < 0.1, "wind")
    panel(page, "wind.velocity").locator("button.back").click()
    live.wait(lambda seen: abs(seen["wind"][0]) < 0.1, "calm")
    for key in ("wind.velocity", "admittance.mass"):
        enter(key, "3")
    page.get_by_text("Restore all values").click()
    for key in ("wind.velocity", "admittance.mass"):
        until(lambda key=key: "altered" not in panel(page, key).get_attribute("class"), "no mark")
