"""The page that flies without a server, measured: `python benchmarks/offline_page.py [--minutes 10] [--slow 4]`.

Writes the page as one file, opens it from disk at 800 × 450 in Debian's Chromium without a graphics card, and prints
Markdown: its size compressed, the time to the first picture, the delay from a person's event to a picture that shows
its effect, and how far `zigzag` falls behind the clock on one core and on a slowed processor. Chromium's own throttling
reaches the page but not its workers, so the worker's thread is given a fourth of a processor by a control group
(cgroup 1, as root); without that right, only the page is slowed. Needs Linux, Chromium and Playwright.
"""

from __future__ import annotations

import argparse
import contextlib
import gzip
import math
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from machine import describe, heading, table
from playwright.sync_api import Browser, Page, sync_playwright

from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.page_modules import packed_flights

CHROMIUM = "/usr/bin/chromium"
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")
SIZE = {"width": 800, "height": 450}
OPENINGS = 5
PULLING, RADIUS, TURN, MOUSE = 20.0, 60.0, 4.0, 100.0  # s; pixels; s of a circle; places a second
GROUP = Path("/sys/fs/cgroup/cpu/tandemlift-page")
HELD = 0.4  # s, after which the page says who holds the beam
PERIOD = 4000  # µs of a control group
STATUSES = """
globalThis.late = [];
const Plain = Worker;
globalThis.Worker = class extends Plain {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", ({ data }) => data.type === "status" && globalThis.late.push(data.behind_ms));
  }
};
"""


def opened(browser: Browser, address: str) -> Page:
    """The page, once its first picture is drawn."""
    page = browser.new_context(viewport=SIZE).new_page()
    page.add_init_script(STATUSES)
    page.goto(address)
    while not page.evaluate("performance.getEntriesByName('first picture').length"):
        time.sleep(0.02)
    return page


def first_picture(browser: Browser, address: str) -> list[float]:
    """Times from the beginning of the navigation to the first picture [s]."""
    found = []
    for _ in range(OPENINGS):
        page = opened(browser, address)
        found.append(page.evaluate("performance.getEntriesByName('first picture')[0].startTime") / 1000)
        page.context.close()
    return found


def grabbed(page: Page) -> tuple[float, float]:
    """Take hold of the beam; where on the page that is."""
    box = page.locator("#surface canvas").bounding_box()
    assert box
    x, middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for y in range(int(middle) - 60, int(middle) + 120, 6):  # down the picture, until the beam is there
        page.mouse.move(x, y)
        page.mouse.down()
        time.sleep(HELD)
        if page.inner_text("#meters .held-by dd") == "you":
            return x, y
        page.mouse.up()
    sys.exit("the beam was not found on the page")


def latency(browser: Browser, address: str) -> float:
    """Median delay from an event of the mouse to a picture of its effect [ms], while it circles with the beam."""
    page = opened(browser, address)
    time.sleep(7.0)  # the flight lifts off
    x, y = grabbed(page)
    began = time.monotonic()
    while (now := time.monotonic() - began) < PULLING:
        angle = 2 * math.pi * now / TURN
        page.mouse.move(x + RADIUS * math.sin(angle), y + RADIUS * (1 - math.cos(angle)))
        time.sleep(1 / MOUSE)
    text = page.inner_text("#meters .latency dd")
    page.mouse.up()
    page.context.close()
    return float(text.removesuffix("ms"))


def behind(browser: Browser, address: str, minutes: float, slow: float) -> tuple[list[float], bool]:
    """The largest delay of the flight in each quarter of a second [ms]; whether its worker is slowed."""
    page = opened(browser, address)
    session = page.context.new_cdp_session(page)
    session.send("Emulation.setCPUThrottlingRate", {"rate": slow})
    with slowed_workers(slow) as is_slowed:
        time.sleep(2.0)
        page.evaluate("globalThis.late.length = 0")
        time.sleep(60 * minutes)
        late = page.evaluate("globalThis.late")
    page.context.close()
    return late, is_slowed


@contextlib.contextmanager
def slowed_workers(slow: float) -> Iterator[bool]:
    """Give the threads of workers a part of a processor; whether that was possible."""
    try:
        GROUP.mkdir(exist_ok=True)
        (GROUP / "cpu.cfs_period_us").write_text(str(PERIOD))
        (GROUP / "cpu.cfs_quota_us").write_text(str(round(PERIOD / slow)))
    except OSError:
        yield False
        return
    threads = [t.parent for t in Path("/proc").glob("[0-9]*/task/*/comm") if _name(t) == "DedicatedWorker"]
    for thread in threads:
        (GROUP / "tasks").write_text(thread.name)
    try:
        yield bool(threads)
    finally:
        for thread in threads:
            with contextlib.suppress(OSError):
                (GROUP.parent / "tasks").write_text(thread.name)
        with contextlib.suppress(OSError):
            GROUP.rmdir()


def _name(comm: Path) -> str:
    try:
        return comm.read_text().strip()
    except OSError:
        return ""


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="of zigzag")
    parser.add_argument("--slow", type=float, default=4.0, help="how many times slower the processor is made")
    given = parser.parse_args()
    os.sched_setaffinity(0, [max(os.sched_getaffinity(0))] if given.minutes else os.sched_getaffinity(0))
    print(heading(describe(["tandemlift", "playwright"])))
    html = pages.offline_html(packed_flights(), page_files())
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder) / "page.html"
        file.write_text(html, "utf-8")
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        pictures = first_picture(browser, file.as_uri())
        delay = latency(browser, file.as_uri())
        rows = [
            ("page, compressed", f"{len(gzip.compress(html.encode(), 9)) / 1e6:.2f} MB"),
            ("first picture from disk", f"{statistics.median(pictures):.2f} s ({max(pictures):.2f} at most)"),
            ("event to picture, median", f"{delay:.0f} ms"),
        ]
        if given.minutes:
            late, is_slowed = behind(browser, f"{file.as_uri()}#mission=zigzag", given.minutes, given.slow)
            what = f"page and worker {given.slow:g}× slower" if is_slowed else f"page {given.slow:g}× slower"
            text = f"{statistics.median(late):.0f} ms, {max(late):.0f} ms at most"
            rows.append((f"zigzag behind the clock, one core, {what}, {given.minutes:g} min", text))
        browser.close()
    print(table(("the page without a server", "measured"), rows))


if __name__ == "__main__":
    main()
