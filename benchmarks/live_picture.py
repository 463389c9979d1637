"""The README's first picture: `python benchmarks/live_picture.py docs/pictures/live.webp`.

The live page as it is, while a mouse leads the beam into the zigzag corridor; time passes slowly for the pictures to be
drawn without a graphics card, and at its own pace in the animation.
"""

from __future__ import annotations

import asyncio
import io
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from live import CHROMIUM, FLAGS, Looker, grabbed, started, until
from PIL import Image
from playwright.async_api import Page, async_playwright
from waiting import PATIENCE

SIZE, SHOWN = {"width": 1200, "height": 750}, (720, 450)
EVERY, SECONDS, SLOWLY = 0.125, 8.0, "0.1"  # s of flight; pace
WAY = np.array([[0.0, 0.0], [5.0, 0.0], [10.0, 3.0], [15.0, 0.0]])  # m, of the corridor
FOLLOWS = 0.5  # s after which the vehicle follows, and the animation begins
AHEAD, PULL, PIXELS = 1.4, 0.42, 55.0  # m ahead on the way, m that the hand is ahead, pixels a metre of correction


def ahead_of(place: np.ndarray) -> np.ndarray:
    """A unit vector towards the way ahead."""
    starts, legs = WAY[:-1], np.diff(WAY, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    shares = np.clip(np.einsum("ij,ij->i", place - starts, legs) / lengths**2, 0.0, 1.0)
    nearest = int(np.argmin(np.linalg.norm(starts + shares[:, None] * legs - place, axis=1)))
    along = shares[nearest] * lengths[nearest] + AHEAD
    if along > lengths[nearest] and nearest + 1 < len(legs):
        nearest, along = nearest + 1, along - lengths[nearest]
    way = starts[nearest] + legs[nearest] * along / lengths[nearest] - place
    return way / np.linalg.norm(way)


class Overheard(Looker):
    """One who hears what the server tells the page, and is no second page at the flight."""

    def watch(self) -> None:
        """Watch nothing by itself."""


async def led(page: Page, looker: Looker) -> list[Image.Image]:
    """Pictures of the page while the beam is led along the corridor."""
    x, y = await grabbed(page)
    pictures, due = list[Image.Image](), looker.seen["time"][0] + FOLLOWS
    end, over = due + SECONDS, time.monotonic() + PATIENCE
    while looker.seen["time"][0] < end:
        if time.monotonic() > over:
            sys.exit(f"{SECONDS:g} s of flight took longer than {PATIENCE:g} s")
        seen = looker.seen
        position, target = seen["position"][:2], seen["hand_target"][:2]
        off = position + PULL * ahead_of(position) - target
        x, y = x - PIXELS * off[1] * 0.3, y - PIXELS * off[0] * 0.3  # forward is up, and world y to the left
        await page.mouse.move(x, y)
        if seen["time"][0] >= due:
            picture = Image.open(io.BytesIO(await page.screenshot()))
            pictures.append(picture.convert("RGB").resize(SHOWN, Image.LANCZOS))
            due += EVERY
    await page.mouse.up()
    return pictures


async def taken(address: str) -> list[Image.Image]:
    """Pictures of the page at an address."""
    async with async_playwright() as playwright:
        looker = Overheard(address)
        browser = await playwright.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
        page = await browser.new_page(viewport=SIZE)
        page.on("websocket", lambda socket: socket.on("framereceived", looker.hear))
        await page.goto(address)
        await until(page, "#mode", "follows")
        await page.get_by_text("level", exact=True).first.click()
        await page.click("#show-panel")
        await page.get_by_label("Speed of the flight").select_option(SLOWLY)
        await asyncio.sleep(1.0)
        pictures = await led(page, looker)
        await browser.close()
    return pictures


def main(path: Path) -> None:
    """Make the animation."""
    with tempfile.TemporaryDirectory() as out, started(out) as (_, address):
        pictures = asyncio.run(taken(address))
    rest, duration = pictures[1:], round(1e3 * EVERY)
    pictures[0].save(path, save_all=True, append_images=rest, duration=duration, loop=0, quality=60)
    print(f"{path}: {len(pictures)} pictures, {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "live.webp"))
