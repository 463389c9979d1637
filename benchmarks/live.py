"""The live page, measured as a person and four lookers-on would load it.

Starts `tandemlift live zigzag`, opens its page in Debian's Chromium without a graphics card, pulls the beam with a
mouse that tells of its place 100 times a second, and prints Markdown: how many targets a second reach the physics, how
long it takes from the event until a picture shows what came of it, how far the flight is behind the clock, and what the
server takes of a processor. The page is drawn in both ways that there are without a card: WebGL alone by SwiftShader,
as Chromium does it by itself, and all of the page by it. Needs Linux, Chromium and Playwright.

    python benchmarks/live.py [--minutes 10] [--size 1280x720]
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from machine import describe, heading, table
from playwright.async_api import Page, ViewportSize, async_playwright
from waiting import PATIENCE, ended, said
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.session.frames import read_frames

CHROMIUM = "/usr/bin/chromium"
FLAGS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking")
ALL = "--use-angle=swiftshader"  # the whole page is drawn by SwiftShader, not its WebGL alone
PULLING, RADIUS, TURN = 20.0, 60.0, 4.0  # s, pixels and s of a circle of the mouse
MOUSE = 100.0  # places a second that it tells of
NAP, LATE = (
    0.002,
    "import time\nwhile True:\n t = time.perf_counter(); time.sleep({nap}); print(time.perf_counter() - t)",
)
LOOKERS = 4
TURN_EVERY, TURNS_A_SAVE = 5.0, 12  # s between two changes of a setting; changes between two savings
KINDS = ((1, 0, 0, 0), ("s", "/s", "ms", "/s"))  # digits and units of what is seen
HELD = 0.4  # s, after which the page tells who holds the beam


class Looker:
    """One who only watches."""

    def __init__(self, address: str) -> None:
        self.address, self.behind, self.frames = address, list[float](), 0
        self.fields: tuple[tuple[str, int], ...] = ()
        self.seen = {"seq": np.zeros(1), "time": np.zeros(1)}
        self.targets = 0
        self.thread = threading.Thread(target=self.watch, daemon=True)
        self.thread.start()

    def watch(self) -> None:
        """Count what is told."""
        where = {"uri": self.address.replace("http", "ws") + "ws", "origin": self.address.rstrip("/")}
        try:
            with connect(**where, ping_timeout=None) as self.socket:
                for told in self.socket:
                    self.hear(told)
        except ConnectionClosed:
            pass

    def say(self, **message: object) -> None:
        """Say something to the flight."""
        self.socket.send(json.dumps(message))

    def hear(self, told: str | bytes) -> None:
        """Take a frame or a text."""
        if isinstance(told, bytes):
            self.frames += 1
            if self.fields:
                before, self.seen = self.seen, {n: v[0] for n, v in read_frames(self.fields, told).items()}
                self.targets += int(np.any(before.get("hand_target") != self.seen["hand_target"]))
            return
        text = json.loads(told)
        if text["type"] == "scene":
            self.fields = tuple((name, count) for name, count in text["fields"])
        elif text["type"] == "status":
            self.behind.append(text["behind_ms"])


@contextlib.contextmanager
def started(out: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """`tandemlift live zigzag` and its address."""
    command = [sys.executable, "-m", "tandemlift", "live", "zigzag", "--no-browser", "--port=0", f"--out={out}"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        yield process, said(process, r"http://\S+")[0]
    finally:
        ended(process)  # by SIGTERM: a process in the background is deaf to Ctrl-C


def processor_time(pid: int) -> float:
    """The processor time of a process [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def until(page: Page, where: str, what: str) -> None:
    """Wait until a place of the page shows a text."""
    end = time.monotonic() + PATIENCE
    while not re.search(what, await page.locator(where).text_content() or ""):
        if time.monotonic() > end:
            sys.exit(f"{where} of the page does not show {what!r}")
        await asyncio.sleep(0.02)


async def grabbed(page: Page) -> tuple[float, float]:
    """Take hold of the beam; where on the page that is."""
    box = await page.locator("#surface canvas").bounding_box()
    assert box
    x, middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for y in np.arange(middle - 60, middle + 120, 6):  # down the picture, until the beam is there
        await page.mouse.move(x, y)
        await page.mouse.down()
        await asyncio.sleep(HELD)
        if await page.locator("#meters .held-by dd").text_content() == "you":
            return x, y
        await page.mouse.up()
    sys.exit("the beam was not found on the page")


async def pulled(page: Page, looker: Looker) -> tuple[float, float, float]:
    """Targets a second that reach the physics, the page's own latency [ms], pictures a second, in a circle."""
    x, y = await grabbed(page)
    mouse, sent = await page.context.new_cdp_session(page), set[asyncio.Task[object]]()
    began, first, shown = time.perf_counter(), looker.targets, list[list[float]]()
    while (passed := time.perf_counter() - began) < PULLING:
        turn = 2.0 * math.pi * passed / TURN
        place = {"x": x + RADIUS * math.sin(turn), "y": y + 0.3 * RADIUS * (1.0 - math.cos(turn))}
        # a mouse does not wait until a page has heard of its last place, as Playwright's does
        event = {"type": "mouseMoved", "button": "left", "buttons": 1, **place}
        sent.add(told := asyncio.create_task(mouse.send("Input.dispatchMouseEvent", event)))
        told.add_done_callback(sent.discard)
        if passed > 2.0 and len(shown) < passed:
            texts = [await page.locator(f"#meters .{n} dd").text_content() for n in ("latency", "frame-rate")]
            shown.append([float(f[0]) if (f := re.match(r"\d+", text or "")) else math.nan for text in texts])
        await asyncio.sleep(1.0 / MOUSE)
    count = looker.targets - first
    await page.mouse.up()
    wait, pictures = np.nanmedian(shown, axis=0)
    return count / passed, float(wait), float(pictures)


async def seen(address: str, looker: Looker, size: ViewportSize, *flags: str) -> tuple[float, float, float, float]:
    """Time to the first picture [s], and what `pulled` measures, in a browser with some flags besides."""
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(executable_path=CHROMIUM, args=[*FLAGS, *flags])
        page = await browser.new_page(viewport=size)
        began = time.perf_counter()
        await page.goto(address)
        await until(page, "#meters .frame-rate dd", "[1-9]|rest")
        picture = time.perf_counter() - began
        await until(page, "#mode", "follows|hold")
        measured = await pulled(page, looker)
        await browser.close()
    return picture, *measured


@contextlib.contextmanager
def idler() -> Iterator[Callable[[], float]]:
    """A process that only sleeps; how late it woke up at most [ms], as a measure of what else the machine had to do."""
    with tempfile.TemporaryFile("w+") as told:
        command = [sys.executable, "-u", "-c", LATE.format(nap=NAP)]
        process = subprocess.Popen(command, stdout=told)
        try:
            yield lambda: 1e3 * (max(map(float, (told.seek(0), told.read().split()[:-1])[1])) - NAP)
        finally:
            ended(process)


def watched(process: subprocess.Popen[str], lookers: list[Looker], seconds: float) -> tuple[float, float, float]:
    """Share of a processor, most that the flight was behind [ms], frames a second at a looker."""
    for looker in lookers:
        looker.behind.clear()
    used, frames, began = processor_time(process.pid), lookers[0].frames, time.perf_counter()
    turned = 0
    while (passed := time.perf_counter() - began) < seconds:
        turned += 1
        lookers[0].say(type="set", seq=turned, key="admittance.damping", value=[1.6 + 0.1 * (turned % 5)] * 3)
        if turned % TURNS_A_SAVE == 0:
            lookers[0].say(type="save", seq=turned, name="measured")
        time.sleep(TURN_EVERY)
    share = (processor_time(process.pid) - used) / passed
    return share, max(lookers[0].behind), (lookers[0].frames - frames) / passed


def pixels(text: str) -> ViewportSize:
    """Width and height, from text such as 800x450."""
    width, height = map(int, text.split("x"))
    return {"width": width, "height": height}


def main() -> None:
    """Print the machine and the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="of flight with four lookers-on")
    parser.add_argument("--size", type=pixels, default="800x450", help="of the page, in pixels")
    options = parser.parse_args()
    print(heading(describe(("tandemlift", "websockets", "llvmlite"))), flush=True)
    with tempfile.TemporaryDirectory() as out, started(out) as (process, address):
        rows = measured(process, address, options.size, 60.0 * options.minutes)
    print("\n" + table(["", "target", "measured"], rows))


def measured(process: subprocess.Popen[str], address: str, page: ViewportSize, seconds: float) -> list[list[str]]:
    """The rows of the table."""
    files = page_files()
    size = sum(len(files[f"/{name}"]) for name in ("index.html", "page.js", "page.css")) / 1e3
    first = Looker(address)
    own = asyncio.run(seen(address, first, page))
    software = asyncio.run(seen(address, first, page, ALL))
    lookers = [first, *[Looker(address) for _ in range(LOOKERS - 1)]]
    with idler() as late:
        share, behind, frames = watched(process, lookers, seconds)
        idle = late()
    over = f"{seconds / 60.0:g} min, {LOOKERS} lookers-on, settings changed and saved meanwhile"
    both = [
        f"{a:.{digits}f} {unit} · {b:.{digits}f} {unit}"
        for a, b, digits, unit in zip(own, software, *KINDS, strict=True)
    ]
    return [
        ["page before compression", "≤ 800 kB", f"{size:.0f} kB"],
        ["first picture", "≤ 2 s", both[0]],
        ["targets that reach the physics", "≥ 40 /s", both[1]],
        ["event → Python → screen, median", "≤ 35 ms", both[2]],
        [f"pictures while the beam is pulled, {page['width']} × {page['height']}", "", both[3]],
        [f"flight behind the clock, at most ({over})", "≤ 20 ms", f"{behind:.1f} ms"],
        ["a process that only sleeps, late at most meanwhile", "", f"{idle:.1f} ms"],
        ["server, of one core", "≤ 25 %", f"{100.0 * share:.1f} %"],
        ["frames at a looker-on", "60 /s", f"{frames:.1f} /s"],
    ]


if __name__ == "__main__":
    main()
