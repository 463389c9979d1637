"""The lecture that ships, in Firefox from disk: keys, a ghost under the same hand, and the size of type."""

import pytest
from firefox import firefox
from patience import until
from repository import ROOT

from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files, with_script

PAGE_DOWN, PAGE_UP = "\ue00f", "\ue00e"
HEADING = "document.querySelector('#lecture header > span')?.textContent"
GHOST = "document.querySelector('.spotlight p.ghost').textContent"
SMALLEST = (
    "Math.min(...[...document.querySelectorAll('#lecture *, #dock *')].filter((e) => e.checkVisibility()"
    " && [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()))"
    ".map((e) => parseFloat(getComputedStyle(e).fontSize)))"
)


@pytest.mark.targets
def test_the_lecture_that_ships_is_given_in_firefox(hover, tmp_path):
    file = tmp_path / "lecture.html"
    script = ROOT / "examples" / "lecture.toml"
    file.write_text(pages.offline_html([hover], with_script(page_files(), script)), "utf-8")
    with firefox() as browser:
        browser.open(file.as_uri(), 1920, 1080)
        for step in range(1, 6):
            until(lambda step=step: (browser.value(HEADING) or "").endswith(f"{step} of 8"), f"step {step}")
            browser.press(PAGE_DOWN if step < 5 else PAGE_UP)
        until(lambda: browser.value(HEADING).endswith("4 of 8"), "the step before")
        until(lambda: browser.value(GHOST).startswith("ghost "), "a ghost")
        assert browser.value(SMALLEST) >= 22.0
        assert browser.wrong == []
