"""The live page in Debian's Chromium: actions of a person, and the view of a second viewer."""

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import numpy as np
import patient_server
import pytest
from patience import PATIENCE, ended, joined, said, until
from PIL import Image
from sessions import GUIDED, THRESHOLD

from tandemlift.apps.live.session.frames import read_frames

CHROMIUM = Path("/usr/bin/chromium")
if not os.environ.get("TANDEMLIFT_REQUIRE_ALL"):
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
SETTINGS = GUIDED | {
    "admittance.threshold": THRESHOLD,
    "phases.lift_start": 0.2,  # s: tests wait for the lift and for landings
    "phases.lift_duration": 2.0,
    "phases.land_duration": 4.0,
}
DROP = """([name, text]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
}"""
SIZE = {"width": 800, "height": 450}
MS = 1e3 * PATIENCE
STILL = 2.0  # pixels between two pictures
REMEMBER = """
window.told = new Set(); // texts that the page shows for some seconds only
new MutationObserver(() => {
  for (const one of document.querySelectorAll("#notices p, #refusal, .label.refusal"))
    if (one.checkVisibility()) window.told.add(one.textContent);
}).observe(document, { attributes: true, characterData: true, childList: true, subtree: true });
"""


class Live:
    """`tandemlift live`, started as usual but with longer timeouts, and the messages to a second viewer."""

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
        """Connect the second viewer."""
        self.address = said(self.process, r"http://\S+")[0]
        self.out, self.scene, self.frame, self.frames, self.status = out, None, None, 0, {}
        self.watching = threading.Thread(target=self.watch, name="who watches", daemon=True)
        self.watching.start()
        self.until(lambda: self.scene and self.frame and self.status, "a scene, a frame and a status")

    def watch(self):
        """Keep the last messages."""
        where = {"uri": self.address.replace("http", "ws") + "ws", "origin": self.address.rstrip("/")}
        patient = {"open_timeout": PATIENCE, "ping_timeout": None}
        with contextlib.suppress(ConnectionClosed), connect(**where, **patient) as socket:
            for told in socket:
                if isinstance(told, bytes):
                    self.frame = told
                    self.frames += 1
                else:
                    self.handle(json.loads(told))

    def handle(self, told):
        if told["type"] == "scene":
            self.scene = told
        elif told["type"] == "status":
            self.status = told

    def look(self):
        """The latest frame."""
        fields = tuple(map(tuple, self.scene["fields"]))
        return {name: value[0] for name, value in read_frames(fields, self.frame).items()}

    def until(self, true, what):
        """As `until`, while messages come."""

        def found():
            assert self.watching.is_alive(), f"the server hung up before {what} came"
            return true()

        return until(found, what)

    def wait(self, true, what):
        return self.until(lambda: next((seen for seen in [self.look()] if true(seen)), None), what)

    def wait_status(self, true, what):
        self.until(lambda: true(self.status), what)

    def wait_frames(self, count):
        """Wait for a number of new frames; the last one."""
        end = self.frames + count
        self.until(lambda: self.frames >= end, f"{count} frames")
        return self.look()

    def close(self):
        assert ended(self.process) == 0
        joined(self.watching)


@contextlib.contextmanager
def launched():
    """A browser."""
    with sync_playwright() as playwright:
        one = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS, timeout=MS)
        yield one
        one.close()


def new_page(browser, size=SIZE, **options):
    """An empty page with the timeouts of tests, the list of its errors, and a memory of what it says."""
    page = browser.new_context(viewport=size, **options).new_page()
    page.set_default_timeout(MS)
    page.add_init_script(REMEMBER)
    page.wrong = []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    return page


def has_said(page, words):
    """Whether the page has shown words in a notice or as a refusal, be it for some seconds only."""
    return any(words in text for text in page.evaluate("[...window.told]"))


def opened(browser, address, prepare=lambda page: None, **options):
    """A page of an address; `prepare(page)` runs before it opens."""
    page = new_page(browser, **options)
    prepare(page)
    page.on("console", lambda said: page.wrong.append(said.text) if said.type == "error" else None)
    page.goto(address)
    page.wait_for_selector("#surface canvas")
    return page


def beam_pixels(page):
    """The pixels of the wooden beam on the page, found by their colour: x, y."""
    box = page.locator("#surface canvas").bounding_box()
    image = np.asarray(Image.open(io.BytesIO(page.screenshot(clip=box, scale="css"))).convert("RGB")).astype(int)
    r, g, b = image[..., 0], image[..., 1], image[..., 2]
    rows, columns = np.nonzero((r > 1.25 * g) & (g > 1.25 * b) & (r > 70) & (r < 215))
    return box["x"] + columns, box["y"] + rows


def middle_of_the_beam(page):
    """The middle of the wooden beam on the page, once it stands still there: a page that opened may move it yet."""
    places = [(np.inf, np.inf)]

    def still():
        x, y = beam_pixels(page)
        places.append((np.median(x), np.median(y)) if len(x) >= 100 else (np.inf, np.inf))
        return max(np.abs(np.subtract(*places[-2:]))) <= STILL

    until(still, "a beam that stands still on the page")
    return places[-1]


def with_still_camera(page):
    """Let the camera follow no longer, once it shows the beam: a still cursor is a still target."""
    middle_of_the_beam(page)
    page.keyboard.press("f")


def stopped(page):
    """Stop the rotors in the air, and answer the question; once the page knows that the vehicle flies."""
    until(lambda: page.text_content("#mode") in ("follows pushes", "holding"), "a status on the page")
    page.get_by_role("button", name="Stop").click()
    page.locator("#question").get_by_role("button", name="Stop").click()


def rests(seen):
    return np.abs(seen["velocity"]).max() < 0.02 and seen["held"] == 0.0


def panel(page, key):
    """The input of a setting, in its opened group."""
    if page.get_attribute("#show-panel", "aria-pressed") != "true":
        page.click("#show-panel")
    box = page.locator(f"[data-key='{key}']")
    group = page.locator("#panel details", has=box)
    if group.get_attribute("open") is None:
        group.locator("summary").click()
    return box


def flown_on(page, seconds):
    """Let some seconds of the page's flight pass, however long they take."""
    end = seconds_flown(page) + seconds
    until(lambda: seconds_flown(page) >= end, f"{seconds:g} s of flight")


def pushed(page, seconds=0.5, key="KeyD"):
    """Push by a key for some seconds of the page's flight."""
    page.keyboard.down(key)
    flown_on(page, seconds)
    page.keyboard.up(key)


def resized(page, size):
    """Give the page a size, and wait until its plots stand still in it."""
    page.set_viewport_size(size)
    boxes = [None]

    def still():
        boxes.append(page.locator(".plot .u-over").first.bounding_box())
        page.evaluate("new Promise((done) => setTimeout(done, 300))")
        return boxes[-1] == boxes[-2] and page.evaluate("window.innerWidth") == size["width"]

    until(still, "plots of that size")


def paused(page):
    """Whether the flight stands still."""
    return page.locator("#dock span:text-is('Continue')").count() == 1


def seconds_flown(page):
    """The time of the flight that the page shows [s]."""
    return float(page.inner_text("#meters .time dd").removesuffix("s").replace("–", "-1"))


def aloft(browser, address, size, seconds=6.0, **options):
    """A page of a size whose flight is at its height; before it is small: software draws large pictures slowly."""
    page = opened(browser, address, **options)
    until(lambda: seconds_flown(page) > seconds, "a flight at its height")
    resized(page, size)
    return page


def save(page, folder):
    """Save a page's own flight by its dialog, unpacked into a folder; the name of the file."""
    page.click("#dock span:text-is('Save')")
    page.fill("#save-name", "by-hand")
    with page.expect_download(timeout=MS) as download:
        page.click("#saving button[type=submit]")
    zipfile.ZipFile(download.value.path()).extractall(folder)
    return download.value.suggested_filename


def grabbed(page, live):
    """Grab the beam at its middle; the place on the page."""
    live.wait(rests, "rest")
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    live.wait(lambda seen: seen["held"] == 1.0, "hold of the beam")
    return x, y


def dropped(page, text, name="talk.toml"):
    """Drop a file on the page."""
    page.evaluate(DROP, [name, text])
