"""The live page in a real browser, with real events of a mouse: what a person would do, and see."""

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import patient_server
import pytest
import slow_compiler
from patience import PATIENCE, ended, joined, said, until
from PIL import Image
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.live.frames import read_frames
from tandemlift.live.pages import page_files
from tandemlift.live.replay import replay_html

REQUIRED = os.environ.get("TANDEMLIFT_REQUIRE_ALL")
CHROMIUM = Path("/usr/bin/chromium")
if not REQUIRED:
    pytest.importorskip("playwright")
    if not CHROMIUM.exists():
        pytest.skip("Debian's Chromium is not installed", allow_module_level=True)

from playwright.sync_api import sync_playwright  # noqa: E402
from websockets.exceptions import ConnectionClosed  # noqa: E402
from websockets.sync.client import connect  # noqa: E402

FLAGS = (
    *("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)
SETTINGS = {
    "pilot.guidance": "hand",
    "phases.rotors": "flight",
    "ground.model": "floor",
    "compliance.yaw.model": "yielding",
    "admittance.threshold": 0.3,
}
SIZE = {"width": 800, "height": 450}
MS = 1e3 * PATIENCE


class Live:
    """`tandemlift live`, as a person starts it but for its patience, and what it shows to one who only watches."""

    def __init__(self, out, program=patient_server.__file__):
        settings = [f"--set={key}={value}" for key, value in SETTINGS.items()]
        command = [sys.executable, program, "live", "hover", "--no-browser", "--port=0", f"--out={out}"]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
        self.process = subprocess.Popen([*command, *settings], stdout=subprocess.PIPE, text=True, env=environment)
        try:
            self.begin(out)
        except BaseException:
            ended(self.process, signal.SIGKILL)
            raise

    def begin(self, out):
        """See what it shows."""
        self.address = said(self.process, r"http://\S+")[0]
        self.out, self.scene, self.frame, self.frames, self.status = out, None, None, 0, {}
        self.watching = threading.Thread(target=self.watch, name="who watches", daemon=True)
        self.watching.start()
        self.until(lambda: self.scene and self.frame and self.status, "a scene, a frame and a status")

    def watch(self):
        """Keep what is told last."""
        where = {"uri": self.address.replace("http", "ws") + "ws", "origin": self.address.rstrip("/")}
        patient = {"open_timeout": PATIENCE, "ping_timeout": None}
        with contextlib.suppress(ConnectionClosed), connect(**where, **patient) as socket:
            for told in socket:
                if isinstance(told, bytes):
                    self.frame = told
                    self.frames += 1
                else:
                    self.heed(json.loads(told))

    def heed(self, told):
        if told["type"] == "scene":
            self.scene = told
        elif told["type"] == "status":
            self.status = told

    def look(self):
        """The latest frame."""
        fields = tuple(map(tuple, self.scene["fields"]))
        return {name: value[0] for name, value in read_frames(fields, self.frame).items()}

    def until(self, true, what):
        """As `until`, as long as it is told anything."""

        def found():
            assert self.watching.is_alive(), f"the server hung up before {what} came"
            return true()

        return until(found, what)

    def wait(self, true, what):
        return self.until(lambda: next((seen for seen in [self.look()] if true(seen)), None), what)

    def wait_status(self, true, what):
        self.until(lambda: true(self.status), what)

    def wait_frames(self, count):
        """Wait for so many frames of now; what is seen in the last one."""
        end = self.frames + count
        self.until(lambda: self.frames >= end, f"{count} frames")
        return self.look()

    def close(self):
        assert ended(self.process) == 0
        joined(self.watching)


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    one = Live(tmp_path_factory.mktemp("live"))
    try:
        yield one
    finally:
        one.close()


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        one = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS, timeout=MS)
        yield one
        one.close()


def opened(browser, address, prepare=lambda page: None, **options):
    """A page, and the list of what went wrong on it; `prepare` is done to it before it opens the address."""
    page = browser.new_context(viewport=SIZE, **options).new_page()
    page.set_default_timeout(MS)
    prepare(page)
    page.wrong = []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    page.on("console", lambda said: page.wrong.append(said.text) if said.type == "error" else None)
    page.goto(address)
    page.wait_for_selector("#surface canvas")
    return page


@pytest.fixture
def page(browser, live):
    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    one = opened(browser, live.address)
    until(lambda: one.text_content("#mode") in ("guided", "holding", "hold"), "a status on the page")
    yield one
    assert one.wrong == []
    one.context.close()


def middle_of_the_beam(page):
    """Where on the page the middle of the wooden beam is: the middle of what has its colour."""

    def seen():
        box = page.locator("#surface canvas").bounding_box()
        image = np.asarray(Image.open(io.BytesIO(page.screenshot(clip=box))).convert("RGB")).astype(int)
        r, g, b = image[..., 0], image[..., 1], image[..., 2]
        rows, columns = np.nonzero((r > 1.25 * g) & (g > 1.25 * b) & (r > 70) & (r < 215))
        return None if len(rows) < 100 else (box["x"] + np.median(columns), box["y"] + np.median(rows))

    return until(seen, "a beam on the page")


def rests(seen):
    return np.abs(seen["velocity"]).max() < 0.02 and seen["held"] == 0.0


def test_grabbed_and_pulled_the_beam_follows_the_cursor_and_rests_when_it_is_let_go(page, live):
    page.keyboard.press("f")  # the camera does not follow: a still cursor is a still target
    before = live.wait(rests, "rest")
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    for i in range(20):
        page.mouse.move(x + 6 * i, y, steps=1)
        time.sleep(0.02)
    live.wait(lambda s: np.linalg.norm(s["hand_target"] - before["position"]) > 0.3, "a target that moved")
    assert live.status["holder"] == "other"

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


def test_one_holds_the_beam_at_a_time_and_a_page_that_is_closed_lets_go(page, live, browser):
    live.wait(rests, "rest")
    other = opened(browser, live.address)
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    held = live.look()["hand_point"]
    until(
        lambda: "else" in (other.text_content("#meters") or "") or "other" in (other.text_content("#meters") or ""),
        "the holder told",
    )
    u, v = middle_of_the_beam(other)
    other.mouse.move(u + 30, v)
    other.mouse.down()
    other.mouse.move(u + 60, v)
    until(lambda: "somebody else holds the beam" in other.locator("#notices").text_content(), "a refusal")
    assert np.allclose(live.look()["hand_point"], held, atol=1e-6)
    other.mouse.up()
    assert live.look()["held"] == 1.0
    other.context.close()
    page.context.close()
    live.wait(lambda seen: seen["held"] == 0.0, "release by a closed page")
    live.wait(rests, "rest")


def panel(page, key):
    """The box of a setting, its group opened."""
    if page.get_attribute("#show-panel", "aria-pressed") != "true":
        page.click("#show-panel")
    box = page.locator(f"[data-key='{key}']")
    group = page.locator("#panel details", has=box)
    if group.get_attribute("open") is None:
        group.locator("summary").click()
    return box


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


def test_a_key_pushes_with_the_force_that_is_stated(page, live):
    live.wait(rests, "rest")
    page.locator("#surface canvas").hover()
    page.keyboard.down("ArrowUp")
    live.wait(lambda seen: abs(np.linalg.norm(seen["push"]) - 3.0) < 0.05, "a push of 3 N")
    page.keyboard.up("ArrowUp")
    live.wait(lambda seen: np.linalg.norm(seen["push"]) < 0.01, "no push")
    live.wait(rests, "rest")


GAMEPAD = """
window.pad = { connected: true, axes: [0, 0, 0, 0], buttons: [] };
navigator.getGamepads = () => [null, window.pad];
"""


def test_a_gamepad_pushes_beyond_its_dead_zone_and_lets_go_when_it_is_unplugged(browser, live):
    live.wait_status(lambda s: s["phase"] in ("guided", "hold"), "hover")
    live.wait(rests, "rest")
    page = opened(browser, live.address, lambda one: one.add_init_script(GAMEPAD))
    until(lambda: page.text_content("#mode") in ("guided", "holding", "hold"), "a status on the page")
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


def test_a_dead_rotor_is_marked_on_every_page(browser, live):
    def told(socket):
        server = socket.connect_to_server()
        server.on_message(
            lambda told: socket.send(told if isinstance(told, bytes) else told.replace('"dead":[]', '"dead":[2]'))
        )

    page = opened(browser, live.address, lambda one: one.route_web_socket("**/ws", told))
    until(lambda: page.locator("#panel g.dead").count() == 1, "a rotor that is marked")
    assert page.locator("#panel g.dead").get_attribute("aria-label") == "Stop rotor 3"
    page.context.close()


def test_the_keys_push_no_harder_than_the_hand_of_the_mission(page, live):
    most = live.scene["spring"]["max_force"]
    panel(page, "admittance.mass")  # opens the panel
    entry = page.locator("#key-force")
    entry.fill("50")
    entry.press("Enter")
    until(lambda: float(entry.input_value()) == most, "the most that the hand can")


def test_time_stands_still_while_it_is_paused(page, live):
    page.keyboard.press("p")
    live.wait_status(lambda status: status["paused"], "a pause")
    then = live.wait_frames(2)["time"]
    assert live.wait_frames(20)["time"] == then
    page.keyboard.press("p")
    live.wait_status(lambda status: not status["paused"], "time going on")


def test_who_looks_away_lets_go(page, live):
    live.wait(rests, "rest")
    page.mouse.move(*middle_of_the_beam(page))
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    page.evaluate("window.dispatchEvent(new Event('blur'))")
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    page.mouse.up()


def test_what_is_saved_on_the_page_flies_again_to_the_last_bit(page, live):
    page.click("text=Save")
    page.fill("#save-name", "from-the-page")
    page.keyboard.press("Enter")
    folder = live.out / "from-the-page"
    until((folder / "flight.npz").exists, "a flight")
    saved, again = tl.Flight.load(folder / "flight.npz"), tl.fly(tl.load_mission(folder / "recorded.toml"))
    for channel in saved.channels:
        np.testing.assert_array_equal(saved[channel], again[channel], channel)


def grabbed(page, live):
    """The beam held at its middle; where on the page that is."""
    live.wait(rests, "rest")
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    return x, y


def test_the_wheel_moves_the_target_away_from_who_looks(page, live):
    grabbed(page, live)
    before = live.look()["hand_target"]
    page.mouse.wheel(0, -200)
    live.wait(lambda seen: np.linalg.norm(seen["hand_target"] - before) > 0.1, "a target farther away or nearer")
    page.mouse.up()
    live.wait(rests, "rest")


def test_pulled_at_the_centre_of_mass_the_hand_is_there(page, live):
    panel(page, "admittance.mass")  # opens the panel
    page.get_by_text("centre of mass", exact=True).click()
    x, y = grabbed(page, live)
    page.mouse.move(x + 40, y)
    live.wait(lambda seen: np.linalg.norm(seen["push"]) > 0.3, "a pull")
    assert np.abs(live.look()["hand_point"]).max() < 1e-6
    page.mouse.up()
    live.wait(rests, "rest")


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
        time.sleep(0.03)
    live.wait(lambda seen: np.linalg.norm(seen["push"]) > 0.3, "a pull")
    finger("touchEnd")
    live.wait(lambda seen: seen["held"] == 0.0, "release")
    live.wait(rests, "rest")


def test_time_passes_as_slowly_as_is_asked(page, live):
    page.get_by_label("Pace of time").select_option("0.25")
    live.wait_status(lambda status: status["speed"] == 0.25, "a quarter of the pace")
    page.get_by_label("Pace of time").select_option("1")
    live.wait_status(lambda status: status["speed"] == 1.0, "its own pace")


def test_all_settings_come_back_at_once(page, live):
    for key, value in (("wind.velocity", "1"), ("admittance.mass", "3")):
        entry = panel(page, key).locator("input[type=number]").first
        entry.fill(value)
        entry.press("Enter")
        until(lambda key=key: "altered" in panel(page, key).get_attribute("class"), "a mark of what is altered")
    page.get_by_text("All back to the mission's").click()
    for key in ("wind.velocity", "admittance.mass"):
        until(lambda key=key: "altered" not in panel(page, key).get_attribute("class"), "no mark")


def test_who_is_not_to_be_heard_is_not_and_stop_stops_at_once(page, live):
    page.get_by_role("button", name="Enabled").click()
    live.wait_status(lambda status: not status["enabled"], "a pilot that does not listen")
    page.get_by_role("button", name="Disabled").click()
    live.wait_status(lambda status: status["enabled"], "a pilot that listens")
    page.get_by_role("button", name="Stop").click()
    live.wait_status(lambda status: status["phase"] in ("stopped", "lost"), "stopped rotors")
    page.get_by_role("button", name="Reset").click()
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")


def test_it_lands_is_reset_and_the_page_begins_anew(page, live):
    page.click("text=Land")
    live.wait_status(lambda status: status["phase"] in ("land", "idle"), "a landing")
    page.click("text=Reset")
    live.wait(lambda seen: seen["time"] < 5.0, "a new flight")
    live.wait_status(lambda status: status["phase"] in ("guided", "hold"), "hover")


BUTTONS = ("Lift", "Land", "Stop", "Pause", "Save")


@pytest.mark.parametrize("size", [(1280, 800), (800, 450), (390, 844)])
def test_nothing_on_the_page_is_cut_off_at_any_size(browser, live, size):
    page = opened(browser, live.address)
    page.set_viewport_size({"width": size[0], "height": size[1]})

    def cut_off():
        boxes = {n: page.get_by_role("button", name=n).first.bounding_box() for n in BUTTONS}
        inside = [
            name
            for name, box in boxes.items()
            if box and box["x"] >= 0.0 and box["x"] + box["width"] <= size[0] and box["y"] + box["height"] <= size[1]
        ]
        wide = page.evaluate("document.documentElement.scrollWidth") > size[0]
        return set(BUTTONS) - set(inside) | ({"the page"} if wide else set())

    until(lambda: not cut_off(), "a page of that size")
    page.context.close()


def test_a_replay_opens_from_disk_with_the_network_off(browser, tmp_path):
    flight = tl.fly(tl.load_mission("one-push"))
    html = tmp_path / "replay.html"
    html.write_text(replay_html(flight, page_files()), "utf-8")
    asked = []
    context = browser.new_context(viewport=SIZE, offline=True)
    page = context.new_page()
    page.set_default_timeout(MS)
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: asked.append(str(error)))
    page.goto(html.as_uri())
    page.wait_for_selector("#surface canvas")
    middle_of_the_beam(page)
    slider = page.get_by_label("Time", exact=True)
    slider.fill("10")
    until(lambda: abs(float(page.locator("output b").text_content()) - 10.0) < 1.0, "the time of the slider")
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    context.close()


def test_while_it_is_compiled_the_page_shows_the_vehicle_and_what_is_waited_for(browser, tmp_path, monkeypatch):
    goes_on = tmp_path / "goes on"
    monkeypatch.setenv("COMPILES_UNTIL", str(goes_on))
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    one = Live(tmp_path, slow_compiler.__file__)
    try:
        page = opened(browser, one.address)
        until(lambda: page.text_content("#mode") == "being prepared", "its mode")
        assert page.text_content("#hint") == "Preparing the flight: compiling the flight loop \u2026"
        assert page.is_visible("#hint")
        middle_of_the_beam(page)
        assert not page.locator("#meters .speed .late").count()
        goes_on.touch()
        until(lambda: page.text_content("#mode") not in ("being prepared", "connecting"), "a flight")
        until(lambda: "Preparing" not in page.text_content("#hint"), "an end of the hint")
        assert page.wrong == []
        page.context.close()
    finally:
        one.close()
