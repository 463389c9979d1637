"""The page as a whole: its sizes, a replay from disk, and what it shows before the flight begins."""

import slow_compiler
from chromium import Live, middle_of_the_beam, new_page, opened
from patience import until

BUTTONS = ("Lift", "Land", "Stop", "Pause", "Save")


def test_nothing_on_the_page_is_cut_off_at_any_size(browser, live):
    page = opened(browser, live.address)

    def cut_off(size):
        boxes = {n: page.get_by_role("button", name=n).first.bounding_box() for n in BUTTONS}
        inside = [
            name
            for name, box in boxes.items()
            if box and box["x"] >= 0.0 and box["x"] + box["width"] <= size[0] and box["y"] + box["height"] <= size[1]
        ]
        wider = (
            "[document.documentElement, document.getElementById('meters')].some((e) => e.scrollWidth > e.clientWidth)"
        )
        return set(BUTTONS) - set(inside) | ({"the page or its meters"} if page.evaluate(wider) else set())

    for size in ((1280, 800), (1200, 750), (800, 450)):  # phones: `test_looks.py`
        page.set_viewport_size({"width": size[0], "height": size[1]})
        until(lambda size=size: not cut_off(size), "a page of that size")
    page.context.close()


def test_a_replay_opens_from_disk_with_the_network_off(browser, replay):
    asked = []
    page = new_page(browser, offline=True)
    page.on("request", lambda request: asked.append(request.url))
    page.goto(replay)
    page.wait_for_selector("#surface canvas")
    middle_of_the_beam(page)
    page.get_by_title("Play or pause (P)").click()
    page.get_by_label("Time", exact=True).fill("10")
    until(lambda: abs(float(page.locator("output b").text_content()) - 10.0) < 1.0, "the time of the slider")
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert page.wrong == []
    page.context.close()


def test_while_it_is_compiled_the_page_shows_the_vehicle_and_what_is_waited_for(browser, tmp_path, monkeypatch):
    goes_on = tmp_path / "goes on"
    monkeypatch.setenv("COMPILES_UNTIL", str(goes_on))
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    one = Live(tmp_path, slow_compiler.__file__)
    try:
        page = opened(browser, one.address)
        until(lambda: page.text_content("#mode") == "preparing", "its mode")
        hint = "Preparing the flight: compiling the flight loop \u2026"
        until(lambda: page.text_content("#hint") == hint, "what it waits for")
        assert page.is_visible("#hint")
        middle_of_the_beam(page)
        assert not page.locator("#meters .speed .late").count()
        goes_on.touch()
        until(lambda: page.text_content("#mode") not in ("preparing", "connecting"), "a flight")
        until(lambda: "Preparing" not in page.text_content("#hint"), "an end of the hint")
        assert page.wrong == []
        page.context.close()
    finally:
        one.close()
