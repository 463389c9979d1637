"""The copy buttons of a study's page, pressed in a browser that opened it from disk, without a network."""

import pytest
from sideways import SIDEWAYS
from small_studies import made_up

from tandemlift.pictures.report.study.study_report import write_study_report

pytest.importorskip("playwright")
STUDY = {
    "study": {"name": "gusts", "missions": ["one-push"], "draws": 12},
    "draw": {"plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.2}},
}
SIZES = {"desktop": {"width": 1280, "height": 800}, "phone": {"width": 360, "height": 740}}


def measured(rows):
    """Made-up results: the higher its number, the more work a row took."""
    columns = {"outcome": "landed", "reason": "", "finding_kinds": "", "findings": "[]", "events": "[]"}
    return {name: [text] * len(rows) for name, text in columns.items()} | {
        "human_work_j": [1.0 * r.number for r in rows]
    }


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("a study's folder") / "gusts"  # a name that a shell would take apart
    return write_study_report(made_up(STUDY, folder, measured), folder / "report.html")


@pytest.fixture(scope="module")
def browser():
    from chromium import launched

    with launched() as one:
        yield one


def opened(browser, path, prepare="", **options):
    context = browser.new_context(offline=True, **options)
    page = context.new_page()
    page.wrong, page.asked = [], []
    page.on("pageerror", lambda error: page.wrong.append(str(error)))
    page.on("request", lambda request: page.asked.append(request.url))
    page.add_init_script(prepare)
    page.goto(path.as_uri())
    return page


def pasted(page):
    """What is on the clipboard, as a field receives it."""
    page.evaluate("document.body.append(Object.assign(document.createElement('textarea'), {id: 'pasted'}))")
    page.focus("#pasted")
    page.keyboard.press("Control+V")
    return page.input_value("#pasted")


@pytest.mark.parametrize("clipboard", ["allowed", "missing"])
def test_a_press_copies_the_command_that_flies_the_row(browser, path, clipboard):
    without = "Object.defineProperty(Navigator.prototype, 'clipboard', {value: undefined})"
    allowed = {"permissions": ["clipboard-read", "clipboard-write"]} if clipboard == "allowed" else {}
    page = opened(browser, path, "" if clipboard == "allowed" else without, **allowed)
    first = page.locator(".worst .command").first
    row = page.locator(".worst td.number").first.text_content()
    first.locator("button").click()
    page.wait_for_function("document.querySelector('.worst button').textContent === 'Copied'")
    quoted = "'" + str(path.parent).replace("'", "'\"'\"'") + "'"
    assert pasted(page) == f"tandemlift run --from {quoted} --row {row}"
    page.wait_for_function("document.querySelector('.worst button').textContent === 'Copy'")
    assert (page.wrong, page.asked) == ([], [path.as_uri()])
    page.context.close()


@pytest.mark.parametrize("size", SIZES)
def test_the_page_fits_the_screen_and_every_button_can_be_pressed(browser, path, size):
    page = opened(browser, path, viewport=SIZES[size])
    assert page.evaluate(SIDEWAYS) == []
    boxes = [button.bounding_box() for button in page.locator(".command button").all()]
    assert len(boxes) == 1 + page.locator(".worst tbody tr").count() > 4
    assert all(box["x"] >= 0.0 and box["x"] + box["width"] <= SIZES[size]["width"] for box in boxes)
    assert all(box["height"] >= 28.0 and box["width"] >= 40.0 for box in boxes)
    page.context.close()


@pytest.mark.thorough
def test_without_scripts_there_is_no_button_that_does_nothing(browser, path):
    page = opened(browser, path, java_script_enabled=False)
    assert page.locator(".command code").first.is_visible()
    assert not page.locator(".command button").first.is_visible()
    page.context.close()
