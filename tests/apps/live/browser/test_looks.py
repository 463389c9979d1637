"""What a person sees on a phone and in the dark: nothing is cut off or covered, and all can be read."""

from dataclasses import replace

import numpy as np
import pytest
from chromium import beam_pixels, new_page, panel
from patience import until

import tandemlift as tl
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.replay import replay_html

pytestmark = pytest.mark.thorough

PHONES = [(360, 740), (740, 360)]
LONG = "narrow-zigzag-with-a-slow-person"
FINGER = 40  # pixels
SHAPES = """() => {
  const seen = (e) => e.checkVisibility({ visibilityProperty: true }) && e.getBoundingClientRect().width > 0;
  const box = (e) => ["left", "top", "right", "bottom"].map((side) => e.getBoundingClientRect()[side]);
  const all = (of) => [...document.querySelectorAll(of)].filter(seen);
  const named = (e) => `${e.tagName} ${e.id || e.className} ${e.textContent.trim().slice(0, 20)}`;
  return {
    parts: all(".brand b, #mission, #missions, #mode, #meters div, .toggles button, #views, #hint, #dock .strip")
      .map((e) => [named(e), ...box(e), e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0]),
    targets: all("button, select, summary, label.toggle, input[type=number]").map((e) => [named(e), ...box(e)]),
    wide: document.documentElement.scrollWidth,
  };
}"""
TEXTS = """() => {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (text) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = text;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((v, i) => v * a + below[i] * (1 - a));
  const behind = (e) =>
    e ? over(rgba(getComputedStyle(e).backgroundColor), behind(e.parentElement)) : rgba("Canvas").slice(0, 3);
  const light = (c) => c.map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (a, b) => {
    const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  const own = (e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  const texts = [...document.querySelectorAll("body *")].filter((e) => own(e) && e.checkVisibility());
  const paper = behind(document.getElementById("plots"));
  const probe = document.body.appendChild(document.createElement("i"));
  const lines = ["x", "y", "z"].map((a) => `--axis-${a}`)
    .concat([1, 2, 3, 4].flatMap((n) => [`--front-${n}`, `--rear-${n}`]), ["--level", "--red"]);
  return {
    paper,
    texts: texts.map((e) => [e.textContent.trim(), contrast(rgba(getComputedStyle(e).color).slice(0, 3), behind(e))]),
    lines: lines.map((name) => {
      probe.style.color = `var(${name})`;
      return [name, contrast(rgba(getComputedStyle(probe).color).slice(0, 3), paper)];
    }),
  };
}"""


def phone(browser, address, size, **options):
    """A page on a phone of a size."""
    size = {"width": size[0], "height": size[1]}
    page = new_page(browser, size, has_touch=True, is_mobile=True, **options)
    page.goto(address)
    page.wait_for_selector("#surface canvas")
    return page


def faults(page, size):
    """What is cut off, covers something else, or is too small for a finger."""
    shapes, (width, height) = page.evaluate(SHAPES), size
    found = ["the page is too wide"] if shapes["wide"] > width else []
    parts = shapes["parts"]
    for name, left, top, right, bottom, cut in parts:
        if cut or left < -0.5 or top < -0.5 or right > width + 0.5 or bottom > height + 0.5:
            found.append(f"{name} is cut off")
    for i, (name, *a, _) in enumerate(parts):
        for other, *b, _ in parts[i + 1 :]:
            if min(a[2], b[2]) - max(a[0], b[0]) > 0.5 and min(a[3], b[3]) - max(a[1], b[1]) > 0.5:
                found.append(f"{name} covers {other}")
    for name, left, top, right, bottom in shapes["targets"]:
        if min(right - left, bottom - top) < FINGER - 0.5:
            found.append(f"{name} is {right - left:.0f} by {bottom - top:.0f}")
    return found


@pytest.mark.parametrize("size", PHONES)
def test_on_a_phone_nothing_of_a_flight_is_cut_off_covered_or_too_small_for_a_finger(browser, live, size):
    page = phone(browser, live.address, size)
    until(lambda: page.text_content("#mission") == "hover", "a scene")
    page.evaluate("name => document.getElementById('missions').prepend(new Option(name, name, true, true))", LONG)
    until(lambda: not faults(page, size), f"a page without {faults(page, size)}")
    panel(page, "admittance.mass")
    until(lambda: not faults(page, size), f"settings without {faults(page, size)}")
    beside, picture = page.locator("#panel").bounding_box(), page.locator("#view").bounding_box()
    assert beside["x"] >= picture["x"] + picture["width"] or beside["y"] >= picture["y"] + picture["height"]
    margin = 20.0  # pixels

    def is_whole():
        x, _ = beam_pixels(page)
        return np.ptp(x) > 100.0 and margin < x.min() < x.max() < picture["width"] - margin

    until(is_whole, "a whole beam")
    assert page.evaluate("p => p.scrollWidth <= p.clientWidth", page.query_selector("#panel"))
    page.click("#show-help")
    told = page.get_by_role("dialog", name="Push the beam yourself")
    assert told.locator("dt").first.inner_text() == "Drag the beam with a finger"
    assert page.evaluate("document.getElementById('help').scrollTop") == 0
    assert page.wrong == []
    page.context.close()


@pytest.mark.parametrize("size", PHONES)
def test_on_a_phone_nothing_of_a_replay_is_cut_off_covered_or_too_small_for_a_finger(browser, replay, size):
    page = phone(browser, replay, size)
    until(lambda: not faults(page, size), f"a page without {faults(page, size)}")
    page.context.close()


@pytest.mark.parametrize("colours", ["light", "dark"])
def test_all_texts_and_lines_can_be_read_in_the_colours_that_the_system_prefers(browser, live, colours):
    page = phone(browser, live.address, (390, 844), color_scheme=colours)
    until(lambda: page.text_content("#mission") == "hover", "a scene")
    panel(page, "admittance.mass")
    page.evaluate("document.querySelectorAll('#panel details').forEach((group) => (group.open = true))")
    for dialog in (None, "help"):
        if dialog:
            page.click("#show-help")
        look = page.evaluate(TEXTS)
        assert (sum(look["paper"]) < 128) == (colours == "dark")
        assert [(text, contrast) for text, contrast in look["texts"] if contrast < 4.5] == []
        assert [(name, contrast) for name, contrast in look["lines"] if contrast < 3.0] == []
    page.context.close()


def test_the_colours_that_are_chosen_stay_whatever_the_system_prefers(browser, live):
    page = phone(browser, live.address, (390, 844), color_scheme="light")
    until(lambda: page.text_content("#mission") == "hover", "a scene")

    def theme():
        return page.evaluate("document.documentElement.dataset.theme")

    def brightness():
        return sum(page.evaluate(TEXTS)["paper"])

    assert theme() == "light"
    panel(page, "admittance.mass")
    page.evaluate("document.querySelectorAll('#panel details').forEach((group) => (group.open = true))")
    page.get_by_role("button", name="dark", exact=True).click()
    assert theme() == "dark"
    assert brightness() < 128
    page.reload()
    page.wait_for_selector("#surface canvas")
    until(lambda: theme() == "dark", "dark colours after a reload")
    assert brightness() < 128
    page.context.close()


EDGES = """() => [...document.querySelectorAll(".plot canvas")].map((canvas) => {
  const { width, height } = canvas;
  const ctx = canvas.getContext("2d");
  const inked = (x) => ctx.getImageData(x, 0, 1, height).data.some((v) => v > 0);
  return [inked(0), inked(width - 1)];
})"""
CUT_HEADS = """() => [...document.querySelectorAll(".plot header")].filter((e) => e.scrollWidth > e.clientWidth)
  .map((e) => e.textContent)"""


def test_the_labels_of_plots_are_whole_at_both_ends(browser, tmp_path):
    html = tmp_path / "far.html"
    flight = tl.fly(tl.load_mission("one-push"))
    far = {name: flight[name] - [7890.0, 0.0, 0.0] for name in ("position", "reference_position")}  # m: long values
    html.write_text(
        replay_html(replace(flight, time=flight.time + 3000.0, channels=flight.channels | far), page_files()), "utf-8"
    )
    page = new_page(browser, {"width": 760, "height": 600})
    page.goto(html.as_uri())
    page.wait_for_selector(".plot canvas")
    page.get_by_title("Play or pause (P)").click()
    for time in ("3010.1", "3005.1", "3008"):  # s: a label at the right end, twice, and none
        page.get_by_label("Time", exact=True).fill(time)
        until(lambda time=time: float(page.locator("output b").text_content()) == float(time), "the time of the slider")
        page.wait_for_timeout(1000.0)  # ms, in which every plot is drawn
        assert page.evaluate(EDGES) == [[False, False]] * 4
    assert page.evaluate(CUT_HEADS) == []
    page.context.close()
