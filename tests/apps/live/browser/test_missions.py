"""Another mission from the page: its menu, and files that are dropped on it or chosen."""

import pytest
from chromium import Live, has_said, opened
from patience import until

import tandemlift as tl

pytestmark = pytest.mark.thorough

MINE = 'extends = "hover"\n[mission]\nname = "mine"\n[admittance]\nmass = 2.5\n'
DROP = """([name, text]) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([text], name));
  const dropped = { dataTransfer, bubbles: true, cancelable: true };
  const surface = document.getElementById("surface");
  for (const kind of ["dragover", "drop"]) surface.dispatchEvent(new DragEvent(kind, dropped));
}"""


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    """A flight of its own, for its mission is exchanged."""
    one = Live(tmp_path_factory.mktemp("live"))
    try:
        yield one
    finally:
        one.close()


@pytest.fixture
def page(browser, live):
    one = opened(browser, live.address)
    until(lambda: one.locator("#missions").count() == 1, "a menu")
    yield one
    assert one.wrong == []
    one.context.close()


def flown(live, mission):
    live.until(lambda: live.scene["mission"] == mission, f"a flight of {mission}")
    live.wait(lambda seen: seen["time"] > 0.1, "a flight that goes on")


def test_the_menu_flies_another_mission_on_every_page(page, live):
    assert page.locator("#missions option").all_inner_texts() == [one["name"] for one in live.scene["missions"]]
    page.select_option("#missions", "iris")
    until(lambda: has_said(page, "Flying iris"), "a notice")
    flown(live, "iris")
    until(lambda: page.text_content("#mission") == "iris", "its scene")
    assert page.input_value("#missions") == "iris"


def test_a_file_is_flown_that_is_dropped_or_chosen(page, live, tmp_path):
    page.evaluate(DROP, ["mine.toml", MINE])
    until(lambda: has_said(page, "Flying mine.toml"), "a notice")
    flown(live, "mine")
    mass = next(one for one in live.scene["parameters"] if one["key"] == "admittance.mass")
    assert mass["value"] == mass["initial"] == [2.5] * 3
    until(lambda: page.input_value("#missions") == "mine", "its name in the menu")
    other = tmp_path / "other.toml"
    other.write_text(MINE.replace("mine", "other"), "utf-8")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Open").click()
    chooser.value.set_files(other)
    flown(live, "other")


def test_what_is_no_mission_is_told_in_a_dialog_in_the_words_of_the_terminal(page, live, tmp_path):
    page.select_option("#missions", "doorway")
    flown(live, "doorway")
    until(lambda: page.input_value("#missions") == "doorway", "its name in the menu")
    file = tmp_path / "bad.toml"
    for text in ("\ufffdPNG", MINE + "mas = 2\n", "[mission]\n"):
        file.write_text(text, "utf-8")
        with pytest.raises(tl.InputError) as error:
            tl.load_mission(file)
        page.evaluate(DROP, ["bad.toml", text])
        until(lambda: page.is_visible("#question"), "a dialog")
        assert page.text_content("#question p") == str(error.value).replace(str(file), "bad.toml")
        page.keyboard.press("Escape")
    page.evaluate(DROP, ["long.toml", "#" * 70_000])
    until(lambda: "long.toml: is longer than 65536 bytes" in page.inner_text("#question"), "the reason")
    page.keyboard.press("Escape")
    assert page.input_value("#missions") == "doorway"
    assert live.scene["mission"] == "doorway"
