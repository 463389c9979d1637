"""The page in a notebook: anywidget's own front end is given to a browser, which flies."""

import json

import pytest
from chromium import new_page
from patience import until

import tandemlift as tl

HOST = """<!doctype html><div id="cell"></div><script type="module">
const widget = await import(URL.createObjectURL(new Blob([$esm], { type: "text/javascript" })))
const state = $state
widget.default.render({ model: { get: name => state[name] }, el: document.getElementById("cell") })
</script>"""


@pytest.mark.thorough
def test_a_widget_flies_in_the_cell_of_a_notebook(browser, tmp_path):
    widget = tl.page("hover", height=480)
    state = {"html": widget.html, "height": widget.height}
    assert {"html", "height", "_esm"} <= set(widget.get_state())  # what a front end is sent
    file, text = tmp_path / "cell.html", json.dumps(state).replace("</", "<\\/")
    file.write_text(HOST.replace("$esm", json.dumps(widget.get_state()["_esm"])).replace("$state", text), "utf-8")
    page = new_page(browser)
    page.goto(file.as_uri())
    frame = page.frame_locator("iframe[title=tandemlift]")
    until(lambda: frame.locator("#notices .refused, canvas").first.is_visible(), "the page")
    assert page.locator("iframe").bounding_box()["height"] == 480
    until(lambda: frame.get_by_role("button", name="Pause").is_enabled(), "a flight")
    page.context.close()


def test_a_mission_that_is_not_there_is_refused():
    with pytest.raises(tl.InputError, match="hoover"):
        tl.page("hoover")
