"""Parameters and rotors in the panel."""

from chromium import opened, panel
from patience import until


def test_a_setting_that_is_entered_changes_the_flight_and_comes_back(page, live):
    box = panel(page, "wind.velocity")
    box.locator("input[type=number]").first.fill("2")
    box.locator("input[type=number]").first.press("Enter")
    live.wait(lambda seen: abs(seen["wind"][0] - 2.0) < 0.1, "wind")
    until(lambda: "altered" in box.get_attribute("class"), "a mark of what is altered")
    box.locator("button.back").click()
    live.wait(lambda seen: abs(seen["wind"][0]) < 0.1, "calm")


def test_a_refused_setting_says_why_and_shows_what_it_was(page, live):
    box = panel(page, "admittance.mass")
    entry = box.locator("input[type=number]").first
    before = entry.input_value()
    entry.fill("9999")
    entry.press("Enter")
    until(lambda: "must be from 0.3 to 20" in box.locator(".reason").text_content(), "a reason")
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
    assert page.locator("#panel g.failed").get_attribute("aria-label") == "Stop rotor 3"
    page.context.close()


def test_all_settings_come_back_at_once(page, live):
    for key, value in (("wind.velocity", "1"), ("admittance.mass", "3")):
        entry = panel(page, key).locator("input[type=number]").first
        entry.fill(value)
        entry.press("Enter")
        until(lambda key=key: "altered" in panel(page, key).get_attribute("class"), "a mark of what is altered")
    page.get_by_text("Restore all values").click()
    for key in ("wind.velocity", "admittance.mass"):
        until(lambda key=key: "altered" not in panel(page, key).get_attribute("class"), "no mark")
