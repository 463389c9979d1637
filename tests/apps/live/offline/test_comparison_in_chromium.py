"""Two flights under one hand on the page: kept, told in words and plots, swapped, saved, ended."""

import numpy as np
import pytest
from chromium import aloft, panel, paused, pushed, save
from own_flight import check_flies_again
from patience import until

import tandemlift as tl

pytestmark = pytest.mark.thorough

WIDE = {"width": 1920, "height": 1080}


def test_a_ghost_is_kept_seen_in_words_and_plots_swapped_and_saved(browser, address, tmp_path):
    page = aloft(browser, address, WIDE)
    entry = panel(page, "admittance.damping").locator("input[type=number]").first
    page.get_by_label("Compare").select_option(index=1)
    until(lambda: "same settings" in page.inner_text("#comparison"), "a ghost")
    first = entry.input_value()
    entry.fill("12")
    entry.press("Enter")
    until(lambda: f"damping {first}, now: 12" in page.inner_text("#comparison"), "what differs")
    legends = [keys.split()[-2:] for keys in page.locator(".plot .keys").all_inner_texts()]
    assert [legends[i] for i in (0, 1, 3)] == [["now", "ghost"]] * 3  # a ghost's eight thrusts would be too many
    pushed(page, 1.0)
    page.locator(".plot .u-over").nth(1).hover()
    until(lambda: "ghost x" in page.locator(".plot .values").nth(1).inner_text(), "values of the ghost")
    page.locator("#comparison").get_by_role("button", name="Swap").click()
    until(lambda: entry.input_value() == first, "the settings of the ghost")
    until(lambda: f"damping 12, {first}" in page.inner_text("#comparison").replace("now: ", ""), "the other way round")
    page.keyboard.press("r")
    until(lambda: paused(page), "a flight that stands")
    page.keyboard.press("p")
    save(page, tmp_path)
    page.locator("#comparison").get_by_role("button", name="End").click()
    until(lambda: page.locator("#comparison").is_hidden(), "a flight by itself")
    assert page.wrong == []
    page.context.close()
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))
    assert not tl.load_mission(tmp_path / "recorded.toml").changes  # it was the ghost, which kept its settings
