"""The page that flies by itself in Chromium, from disk: pulled by a real mouse, saved, and flown again in Python."""

import numpy as np
import pytest
from chromium import flown_on, has_said, middle_of_the_beam, new_page, opened, panel, pushed, save, seconds_flown
from click.testing import CliRunner
from own_flight import check_flies_again
from patience import until
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files


def pull_and_push(page):
    """Pull the beam by the mouse, then push it by a key."""
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    for i in range(15):
        page.mouse.move(x + 5.0 * i, y - 2.5 * i)
        flown_on(page, 0.1)  # the hand is recorded once for each step
    until(lambda: page.locator("#surface.pulling").count() == 1, "the page holds the beam")
    page.mouse.up()
    pushed(page)


@pytest.mark.thorough
def test_a_recording_made_by_a_real_mouse_flies_again_in_python_to_the_last_bit(browser, address, tmp_path):
    page = opened(browser, address)
    until(lambda: seconds_flown(page) > 6.0, "a flight at its height")
    entry = panel(page, "person.stiffness").locator("input[type=number]")
    entry.fill("9")
    entry.press("Enter")
    page.click("#show-panel")
    pull_and_push(page)
    assert save(page, tmp_path) == "by-hand.zip"
    assert page.wrong == []
    page.close()
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))
    hand = np.load(tmp_path / "hand.npz")["hand"]
    assert hand[:, 0].max() == 1.0
    assert len(np.unique(hand[:, 4:7], axis=0)) > 10  # targets
    assert np.linalg.norm(hand[:, 7:10], axis=1).max() == pytest.approx(3.0)  # the key's force
    changes = tl.load_mission(tmp_path / "recorded.toml").changes
    assert [(c.key, c.value) for c in changes] == [("person.stiffness", 9.0)]


def test_a_shake_and_a_tap_are_recorded_step_by_step_and_fly_again_to_the_last_bit(browser, address, tmp_path):
    page = opened(browser, address)
    until(lambda: seconds_flown(page) > 6.0, "a flight at its height")
    page.keyboard.press("6")
    page.get_by_role("slider").first.fill("2.5")
    x, y = middle_of_the_beam(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60.0, y, steps=5)
    flown_on(page, 1.0)
    page.mouse.up()
    flown_on(page, 3.0)  # the picture of a busy page shows what was flown a second before
    page.keyboard.press("7")
    page.keyboard.press("w")
    flown_on(page, 0.5)
    save(page, tmp_path)
    assert page.wrong == []
    page.close()
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))
    flight = tl.fly(tl.load_mission(tmp_path / "recorded.toml"))
    push, time = np.linalg.norm(flight["push_force"], axis=1), flight.time
    strong = np.flatnonzero(push > 0.1)
    shake, tap = np.split(strong, np.flatnonzero(np.diff(time[strong]) > 0.1) + 1)
    along = flight["push_force"][shake] @ flight["push_force"][shake[0]]
    assert np.count_nonzero(np.diff(np.sign(along))) >= 4  # in 1 s of 2.5 Hz
    assert push[tap].max() == pytest.approx(3.0, abs=0.2)  # N, of the key, seen each 10 ms
    assert 0.02 < time[tap[-1]] - time[tap[0]] < 0.06  # s


@pytest.mark.thorough
def test_an_own_mission_with_an_own_controller_flies_from_the_file_that_the_command_wrote(browser, tmp_path):
    mission, controller = tmp_path / "mine.toml", ROOT / "docs" / "reference" / "listings" / "my_pd.py"
    mission.write_text('extends = "hover"\n[mission]\nname = "mine"\n[vehicle.payload]\nmass = 0.7\n', "utf-8")
    page_of = ["page", str(mission), "--controller", str(controller), "--html", str(tmp_path / "mine.html")]
    done = CliRunner().invoke(cli, page_of, standalone_mode=False)
    assert done.exception is None
    page = opened(browser, (tmp_path / "mine.html").as_uri())
    assert page.locator("#missions option").all_inner_texts() == ["mine"]
    until(lambda: seconds_flown(page) > 4.0, "a flight at its height")
    assert page.inner_text("#controller") == "my-pd"
    pull_and_push(page)
    entry = panel(page, "controller.stiffness").locator("input[type=number]").first
    entry.fill("5")
    entry.press("Enter")
    until(lambda: page.locator(".parameter.altered[data-key='controller.stiffness']").count(), "the new number")
    save(page, tmp_path)
    assert page.wrong == []
    page.close()
    recorded = tl.load_mission(tmp_path / "recorded.toml")
    assert recorded.controller.name == "my-pd"
    assert [(change.key, change.value[0]) for change in recorded.changes] == [("controller.stiffness", 5.0)]
    check_flies_again(tmp_path / "recorded.toml", np.load(tmp_path / "last_sample.npy"))


def test_a_link_is_read_and_written_and_the_menu_flies_another_flight(browser, address):
    page = opened(browser, f"{address}#mission=hover&admittance.mass=2.5&admittance.damping=99")
    until(lambda: has_said(page, "admittance.damping = 99:"), "a refused setting")
    assert float(panel(page, "admittance.mass").locator("input[type=number]").first.input_value()) == 2.5
    page.click("summary:has-text('This page')")
    page.click("#copy-link")
    until(lambda: page.input_value("#link") == f"{address}#mission=hover&admittance.mass=2.5,2.5,2.5", "the link")
    assert page.locator("#panel .own-flight li").count() == len(pages.ONLY_SERVER)
    assert page.locator("#missions option").all_inner_texts() == ["hover"]
    assert page.get_by_role("button", name="Open").count() == 0
    assert page.wrong == []
    page.close()


@pytest.mark.thorough
def test_an_edited_page_says_that_its_flight_is_damaged(browser, hover, tmp_path):
    text = pages.offline_html([hover._replace(sha256="0" * 64)], page_files())
    (tmp_path / "edited.html").write_text(text, "utf-8")
    page = new_page(browser)
    page.goto((tmp_path / "edited.html").as_uri())
    until(lambda: "its checksum is wrong" in page.inner_text("#hint"), "the reason")
    page.close()


@pytest.mark.thorough
def test_a_browser_without_webassembly_is_told_so_and_shown_a_recorded_flight(browser, address):
    page = opened(browser, address, lambda one: one.add_init_script("delete globalThis.WebAssembly"))
    until(lambda: "runs no WebAssembly" in page.inner_text("#notices"), "the sentence")
    until(lambda: seconds_flown(page) > 0.5, "a replay")
    page.close()
