"""The live page, measured as a person and four lookers-on would load it: `python benchmarks/live.py [--minutes 10]`.

Starts `tandemlift live zigzag`, opens its page at 800 × 450 in Debian's Chromium with software graphics, pulls the beam
with a real mouse, and prints Markdown: how many targets a second reach the physics, how long it takes from the event
until a picture shows what came of it, how far the flight is behind the clock, and what the server takes of a processor.
Needs Linux, Chromium and Playwright.
"""

from __future__ import annotations

import argparse
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
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from machine import describe, heading, table
from playwright.sync_api import Page, sync_playwright
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tandemlift.live.frames import read_frames
from tandemlift.live.pages import page_files

CHROMIUM = "/usr/bin/chromium"
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")
SIZE = {"width": 800, "height": 450}
PULLING, RADIUS, TURN = 20.0, 60.0, 4.0  # s, pixels and s of a circle of the mouse
LOOKERS = 4
TURN_EVERY, TURNS_A_SAVE = 5.0, 12  # s between two changes of a setting; changes between two savings
PATIENCE = 60.0  # s
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
            with connect(**where) as self.socket:
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
    assert process.stdout
    try:
        yield process, next(f for line in process.stdout if (f := re.search(r"http://\S+", line)))[0]
    finally:
        process.terminate()  # a process in the background is deaf to Ctrl-C
        process.wait()


def processor_time(pid: int) -> float:
    """What a process has used of a processor [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def until(page: Page, where: str, what: str) -> None:
    """Wait until a place of the page shows a text."""
    end = time.monotonic() + PATIENCE
    while not re.search(what, page.locator(where).text_content() or ""):
        if time.monotonic() > end:
            sys.exit(f"{where} of the page does not show {what!r}")
        time.sleep(0.02)


def grabbed(page: Page) -> tuple[float, float]:
    """Take hold of the beam; where on the page that is."""
    box = page.locator("#surface canvas").bounding_box()
    assert box
    x, middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for y in np.arange(middle - 60, middle + 120, 6):  # down the picture, until the beam is there
        page.mouse.move(x, y)
        page.mouse.down()
        time.sleep(HELD)
        if page.locator("#meters .held-by dd").text_content() == "you":
            return x, y
        page.mouse.up()
    sys.exit("the beam was not found on the page")


def pulled(page: Page, looker: Looker) -> tuple[float, float]:
    """Targets a second that reach the physics, and the page's own latency [ms], while the mouse goes round."""
    x, y = grabbed(page)
    began, first, waits = time.perf_counter(), looker.targets, list[float]()
    while (passed := time.perf_counter() - began) < PULLING:
        turn = 2.0 * math.pi * passed / TURN
        page.mouse.move(x + RADIUS * math.sin(turn), y + 0.3 * RADIUS * (1.0 - math.cos(turn)))
        if found := re.match(r"\d+", page.locator("#meters .latency dd").text_content() or ""):
            waits.append(float(found[0]))
    count = looker.targets - first
    page.mouse.up()
    return count / passed, float(np.median(waits))


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


def main() -> None:
    """Print the machine and the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="of flight with four lookers-on")
    minutes = parser.parse_args().minutes
    print(heading(describe(("tandemlift", "websockets", "numba"))), flush=True)
    with tempfile.TemporaryDirectory() as out, started(out) as (process, address):
        rows = measured(process, address, 60.0 * minutes)
    print("\n" + table(["", "target", "measured"], rows))


def measured(process: subprocess.Popen[str], address: str, seconds: float) -> list[list[str]]:
    """The rows of the table."""
    files = page_files()
    size = sum(len(files[f"/{name}"]) for name in ("index.html", "page.js", "page.css")) / 1e3
    first = Looker(address)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
        page = browser.new_page(viewport=SIZE)
        began = time.perf_counter()
        page.goto(address)
        until(page, "#meters .pictures dd", "[1-9]")
        picture = time.perf_counter() - began
        until(page, "#mode", "guided")
        rate, wait = pulled(page, first)
        browser.close()
    lookers = [first, *[Looker(address) for _ in range(LOOKERS - 1)]]
    share, behind, frames = watched(process, lookers, seconds)
    over = f"{seconds / 60.0:g} min, {LOOKERS} lookers-on, settings changed and saved meanwhile"
    return [
        ["page before compression", "≤ 800 kB", f"{size:.0f} kB"],
        ["first picture, software graphics", "≤ 2 s", f"{picture:.1f} s"],
        ["targets that reach the physics", "≥ 40 /s", f"{rate:.0f} /s"],
        ["event → Python → screen, median", "≤ 35 ms", f"{wait:.0f} ms"],
        [f"flight behind the clock, at most ({over})", "≤ 20 ms", f"{behind:.1f} ms"],
        ["server, of one core", "≤ 25 %", f"{100.0 * share:.1f} %"],
        ["frames at a looker-on", "60 /s", f"{frames:.1f} /s"],
    ]


if __name__ == "__main__":
    main()
