"""The page that flies by itself in Firefox, from disk: pulled by a mouse, saved, and flown again in Python."""

import base64
import io
import zipfile

import numpy as np
import pytest
from firefox import firefox
from own_flight import check_flies_again
from patience import until
from PIL import Image

from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files

KEEP_FILES = (  # the bytes of the file that the page offers, which a headless browser would ask where to put
    "(() => { const make = URL.createObjectURL.bind(URL);"
    " URL.createObjectURL = (blob) => { globalThis.offered = blob; return make(blob); }; return 1; })()"
)
OFFERED = (
    "globalThis.offered ? globalThis.offered.arrayBuffer().then((b) =>"
    " btoa(Array.from(new Uint8Array(b), (c) => String.fromCharCode(c)).join(''))) : null"
)
SAVE = (
    "(() => { [...document.querySelectorAll('#dock button')].find((b) => b.textContent === 'Save').click();"
    " document.querySelector('#save-name').value = 'fox';"
    " document.querySelector('#saving button[type=submit]').click(); return 1; })()"
)


def beam_on(browser):
    """The middle of the wooden beam on the page, found by its colour."""
    shot = browser.command("browsingContext.captureScreenshot", context=browser._page)["data"]
    image = np.asarray(Image.open(io.BytesIO(base64.b64decode(shot))).convert("RGB")).astype(int)
    r, g, b = image[..., 0], image[..., 1], image[..., 2]
    rows, columns = np.nonzero((r > 1.25 * g) & (g > 1.25 * b) & (r > 70) & (r < 215))
    return None if len(rows) < 100 else (float(np.median(columns)), float(np.median(rows)))


@pytest.mark.targets
def test_a_recording_made_in_firefox_flies_again_in_python_to_the_last_bit(hover, tmp_path):
    file = tmp_path / "own.html"
    file.write_text(pages.offline_html([hover], page_files()), "utf-8")
    with firefox() as browser:
        browser.open(file.as_uri())
        flown = "parseFloat(document.querySelector('#meters .time dd')?.textContent ?? '')"
        until(lambda: (browser.value(flown) or 0.0) > 6.0, "a flight at its height")
        browser.drag(until(lambda: beam_on(browser), "a beam"), (80.0, -40.0))
        until(lambda: browser.value("document.querySelectorAll('#surface.pulling').length") == 1, "a hold")
        held_at = browser.value(flown)
        until(lambda: browser.value(flown) > held_at + 0.2, "a flight with it")
        browser.drop()
        browser.value(KEEP_FILES)
        browser.value(SAVE)
        data = until(lambda: browser.value(OFFERED), "the saved file")
        assert browser.wrong == []
    zipfile.ZipFile(io.BytesIO(base64.b64decode(data))).extractall(tmp_path)
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))
    assert np.load(tmp_path / "hand.npz")["hand"][:, 0].max() == 1.0
