"""Lecture mode on the page: what the steps of a script say is done, type is large, keys step."""

import time

import pytest
from chromium import aloft, dropped, opened, paused, seconds_flown
from click.testing import CliRunner
from patience import until
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli.main import cli

pytestmark = pytest.mark.thorough

HALL = {"width": 1920, "height": 1080}
TYPE = """() => {
  const own = (e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  const written = (e) => e.tagName !== "OPTION" && (own(e) || e.tagName === "SELECT");
  const visible = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
  const seen = [...document.body.querySelectorAll("*")].filter((e) => written(e) && visible(e));
  return seen.map((e) => [e.textContent.trim().slice(0, 40), parseFloat(getComputedStyle(e).fontSize), e.className]);
}"""
CUT = """() => [...document.querySelectorAll("#lecture *, #dock .strip")].filter((e) => {
  const { left, right, top, bottom, width } = e.getBoundingClientRect();
  if (!e.checkVisibility() || width === 0) return false;
  return left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1;
}).map((e) => e.outerHTML.slice(0, 80))"""
SCRIPT = """
title = "A test"
[[steps]]
text = "It hovers."
camera = "side"
spotlight = "height"
[[steps]]
text = "A push."
spotlight = "push"
settings.admittance.damping = 7
push = { force = [0, 1.5, 0], duration = 6.0 }
[[steps]]
text = "With a ghost."
ghost = "keep"
settings.admittance.damping = 14
pause = true
"""


def value(page, key):
    return float(page.locator(f"[data-key='{key}'] input[type=number]").first.input_value())


def said(page):
    """The heading of the lecture, and the text of its step."""
    return page.locator("#lecture header > span").inner_text(), page.locator("#lecture .text").inner_text()


def test_in_a_lecture_values_have_28_pixels_and_texts_22(browser, address):
    page = aloft(browser, address, HALL)
    page.keyboard.press("t")
    until(lambda: page.evaluate("document.fullscreenElement !== null"), "full screen")
    dropped(page, SCRIPT)
    until(lambda: said(page)[0] == "A test · 1 of 3", "the first step")
    page.keyboard.press("PageDown")
    page.keyboard.press("PageDown")
    until(lambda: page.inner_text(".spotlight p.ghost"), "a ghost in the spotlight")
    page.evaluate(
        "document.querySelector('#hint').hidden = false; document.querySelector('#hint').textContent = 'hint'"
    )
    seen = page.evaluate(TYPE)
    assert [one for one in seen if one[1] < 22.0] == []
    large = page.locator(
        ".spotlight .value b, .spotlight .value span, .spotlight p.ghost, #comparison p span, .label:visible"
    )
    sizes = large.evaluate_all("all => all.map((e) => parseFloat(getComputedStyle(e).fontSize))")
    assert len(sizes) >= 4
    assert min(sizes) >= 28.0
    assert page.evaluate(CUT) == []
    assert page.wrong == []
    page.context.close()


def test_keys_go_through_the_steps_of_a_script_which_do_what_they_say(browser, address):
    page = aloft(browser, address, HALL)
    first = value(page, "admittance.damping")
    dropped(page, SCRIPT)
    until(lambda: said(page) == ("A test · 1 of 3", "It hovers."), "the first step")
    assert page.get_by_label("Quantity in the spotlight").input_value() == "height"
    assert page.locator("#views button:text-is('side')").get_attribute("aria-pressed") == "true"
    page.keyboard.press("PageDown")
    until(lambda: value(page, "admittance.damping") == 7.0, "a setting")
    strongest = until(lambda: (v := float(page.inner_text(".spotlight .value b") or 0.0)) > 1.45 and v, "the push")
    assert strongest < 1.55
    until(lambda: float(page.inner_text(".spotlight .value b") or 1.0) < 0.01, "its end")
    page.keyboard.press("Space")
    until(lambda: paused(page) and value(page, "admittance.damping") == 14.0, "a pause")
    until(lambda: "damping 7, now: 14" in page.inner_text("#comparison"), "what differs")
    page.keyboard.press("ArrowRight")  # there is no other step
    page.keyboard.press("PageUp")
    until(lambda: not paused(page) and value(page, "admittance.damping") == 7.0, "the step before")
    until(lambda: page.locator("#comparison").is_hidden(), "no ghost")
    assert said(page)[0] == "A test · 2 of 3"
    assert float(page.inner_text(".spotlight .value b")) < 0.1  # no push on the way back
    page.keyboard.press("ArrowLeft")
    until(lambda: value(page, "admittance.damping") == first, "the mission's own value")
    page.keyboard.press("t")
    until(lambda: page.locator("#lecture").is_hidden() and page.locator("#bar").is_visible(), "the whole page")
    page.keyboard.down("ArrowUp")
    until(lambda: page.locator(".label.push:not([hidden])").count() == 1, "arrows push again")
    page.keyboard.up("ArrowUp")
    assert page.wrong == []
    page.context.close()


def test_without_a_script_keys_turn_the_quantity_and_a_bad_script_is_refused(browser, address):
    page = opened(browser, address)
    until(lambda: seconds_flown(page) > 1.0, "a flight")
    page.locator("#views").get_by_role("button", name="Show").click()
    page.get_by_role("button", name="Lecture, full screen").click()
    menu = page.get_by_label("Quantity in the spotlight")
    assert menu.input_value() == "push"
    for key, name in (("PageDown", "moment"), ("ArrowDown", "speed"), ("PageUp", "moment")):
        page.keyboard.press(key)
        assert menu.input_value() == name
    dropped(page, SCRIPT.replace('"side"', '"top"'), "bad.toml")
    until(lambda: page.locator("#question").is_visible(), "the refusal")
    wanted = 'bad.toml: step 1: camera = "top": must be one of behind, side, above, board'
    assert wanted in page.inner_text("#question")
    page.context.close()


def test_the_command_writes_a_page_that_begins_with_the_script_that_ships(browser, tmp_path):
    file, shipped = tmp_path / "lecture.html", ROOT / "examples" / "lecture.toml"
    wanted = ["page", "hover", "--script", str(shipped), "--html", str(file)]
    assert CliRunner().invoke(cli, wanted, standalone_mode=False).exception is None
    page = opened(browser, file.as_uri())
    until(lambda: said(page)[0].endswith("1 of 8"), "the first step")
    for step in range(2, 9):
        page.keyboard.press("PageDown")
        until(lambda step=step: said(page)[0].endswith(f"{step} of 8"), "the next step")
        time.sleep(0.3)
    until(lambda: value(page, "wind.velocity") == 0.0 and value(page, "admittance.mass") == 1.0, "the settings")
    assert page.locator("#notices .refused").count() == 0
    assert page.wrong == []
    page.context.close()


STEPS = "[[steps]]\ntext = 'a'\n[[steps]]\ntext = 'b'\n"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[[steps]]\ntext = ", "is not valid TOML"),
        ("\ufefftitle = 'a'", "must be one table [[steps]] or more"),
        (f"misson = 'hover'\n{STEPS}", "misson is no key here: must be one of title, mission, steps"),
        (f"mission = 'hovr'\n{STEPS}", 'mission = "hovr": must be one of hover'),
        (f"{STEPS}spotlight = 'hight'", 'step 2: spotlight = "hight": must be one of push, moment, speed, x, '),
        (f"{STEPS}camra = 'behind'", "step 2: camra is no key here: must be one of text, spotlight, camera, "),
        (f"{STEPS}push = {{ force = [1, 0, nan], duration = 1 }}", "step 2: push.force = [1, 0, nan]: must be three"),
        (f"{STEPS}push = {{ duration = 1 }}", "step 2: push.force is missing: must be three numbers, N"),
        ("[[steps]]\npause = true", "step 1: text is missing: must be a text of 1 to 400 characters"),
    ],
)
def test_the_command_refuses_what_is_no_script(tmp_path, text, reason):
    (tmp_path / "talk.toml").write_text(text, "utf-8")
    wanted = ["page", "hover", "--script", str(tmp_path / "talk.toml"), "--html", str(tmp_path / "a.html")]
    with pytest.raises(tl.InputError, match=r"talk\.toml") as refused:
        CliRunner().invoke(cli, wanted, standalone_mode=False, catch_exceptions=False)
    assert reason in str(refused.value)
    assert not (tmp_path / "a.html").exists()
