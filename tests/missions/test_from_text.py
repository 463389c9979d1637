"""A mission from the content of a file: the same, and the same errors, as from the file."""

import pytest
from as_toml import to_toml

import tandemlift as tl
from tandemlift.missions import built_in, load_mission, mission_from_text


@pytest.mark.parametrize("name", built_in())
def test_the_text_of_a_mission_is_the_mission(name):
    mission = load_mission(name)
    assert mission_from_text("mine.toml", to_toml(mission)) == mission
    assert mission_from_text("mine.toml", f'extends = "{name}"') == mission


@pytest.mark.parametrize(
    "text",
    [
        "x = [",
        'extends = "hover"\n[admittance]\nmas = 2',
        'extends = "hover"\n[vehicle.quadrotors.9]\nmass = 1.4',
        "[mission]\nname = 3",
    ],
)
def test_errors_are_those_of_the_file(tmp_path, text):
    file = tmp_path / "mine.toml"
    file.write_text(text, "utf-8")
    with pytest.raises(tl.InputError) as of_file:
        load_mission(file)
    with pytest.raises(tl.InputError) as of_text:
        mission_from_text("mine.toml", text)
    assert str(of_text.value) == str(of_file.value).replace(str(file), "mine.toml")
