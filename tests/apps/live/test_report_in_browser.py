"""The report of `tandemlift run`, opened from disk in a browser without a network: its flight plays, its plots zoom."""

import pytest
from chromium import launched, new_page
from patience import until
from sideways import SIDEWAYS

import tandemlift as tl
from tandemlift.apps.live.replay import report_replay
from tandemlift.pictures.figures.registry import save_figures
from tandemlift.pictures.report.flight_report import write_report

pytestmark = pytest.mark.thorough

LOOKS = """() => [...document.querySelectorAll("#plots .uplot")].map((plot) => Object.fromEntries(
  [...plot.querySelectorAll(".u-series")].slice(1).map((one) => [
    one.querySelector(".u-label").textContent, one.querySelector(".u-marker").style.border])))"""
SIZES = {"desktop": (1280, 900), "phone": (390, 844)}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    flight = tl.fly(tl.load_mission("one-push"))
    return write_report(flight, (), tmp_path_factory.mktemp("flown") / "report.html", report_replay(flight))


@pytest.fixture(scope="module")
def browser():
    with launched() as one:
        yield one


@pytest.mark.parametrize("size", SIZES)
def test_the_flight_plays_and_a_click_in_a_plot_takes_it_to_that_time(browser, path, size):
    width, height = SIZES[size]
    page, asked = new_page(browser, {"width": width, "height": height}), []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    page.wait_for_selector("#flight[data-shown]")
    replay = page.frames[1]
    clock = replay.locator("output b")
    until(lambda: float(clock.inner_text()) > 0.5, "a flight that moves by itself")
    replay.get_by_title("Play or pause (P)").click()
    over = page.locator(".u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    over.click(position={"x": 0.5 * box["width"], "y": 20})
    end = tl.load_mission("one-push").mission.duration
    until(lambda: abs(float(clock.inner_text()) - end / 2) < 0.02 * end, "the time of the click")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.wrong == []
    assert [url for url in asked if not url.startswith(("file:", "blob:", "data:", "about:"))] == []
    page.close()


def test_no_two_lines_of_a_plot_look_alike(browser, path):
    page = new_page(browser, {"width": 1280, "height": 900})
    page.goto(path.as_uri())
    page.wait_for_selector("#flight[data-shown]")
    looks = page.evaluate(LOOKS)
    assert [len(plot) for plot in looks] == [6, 3, 6, 8], "position, velocity, push, thrusts"
    for plot in looks:
        assert len(set(plot.values())) == len(plot), plot
    assert all("dashed" in looks[0][f"{axis} ref"] for axis in "xyz")
    page.close()


def test_a_drag_across_a_plot_zooms_all_plots_and_a_double_click_shows_all_again(browser, path):
    page = new_page(browser, {"width": 1280, "height": 900})
    page.goto(path.as_uri())
    page.wait_for_selector("#flight[data-shown]")
    canvases = page.locator("#plots canvas")
    whole = [canvases.nth(i).evaluate("c => c.toDataURL()") for i in (0, 1)]
    over = page.locator(".u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 30)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 30, steps=4)
    page.mouse.up()
    page.mouse.move(5, 5)
    page.wait_for_function("w => document.querySelector('#plots canvas').toDataURL() !== w", arg=whole[0])
    assert canvases.nth(1).evaluate("c => c.toDataURL()") != whole[1], "the other plots zoom with it"
    over.dblclick()
    page.mouse.move(5, 5)
    page.wait_for_function("w => document.querySelector('#plots canvas').toDataURL() === w", arg=whole[0])
    page.close()


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """A report with all figures and tables of a flight."""
    flight, folder = tl.fly(tl.load_mission("one-push")), tmp_path_factory.mktemp("drawn")
    save_figures(flight, folder / "figures")
    return write_report(flight, folder / "figures", folder / "report.html")


@pytest.mark.parametrize("size", SIZES)
def test_figures_and_tables_fit_the_screen(browser, drawn, size):
    width, height = SIZES[size]
    page = new_page(browser, {"width": width, "height": height})
    page.goto(drawn.as_uri())
    sizes = page.locator(".sheet img").evaluate_all("all => all.map((one) => [one.naturalWidth, one.clientWidth])")
    assert len(sizes) > 5
    assert all(natural > seen > 250 for natural, seen in sizes)
    assert page.evaluate(SIDEWAYS) == []
    page.close()
