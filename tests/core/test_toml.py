"""TOML whose keys have a bounded number of parts."""

import tomllib

import pytest

from tandemlift.core.errors import InputError
from tandemlift.core.files import MAX_PARTS, toml_tables
from tandemlift.missions import Mission
from tandemlift.missions.refusals import keys_of

DEEP = {
    "a key": "{} = 1",
    "a key after others": "x = 'a'\n[y]\n  {} = 1",
    "a table": "[{}]",
    "a list of tables": "[[ {} ]]",
    "a table in line": "x = [ {{ y = 1, {} = 1 }} ]",
}
PARTS = {
    "bare": ".".join("a" * (MAX_PARTS + 1)),
    "spaced": " . ".join("a" * (MAX_PARTS + 1)),
    "quoted": ".".join(['"a b"', "'c.d'", '"\\" ."', '""'] * MAX_PARTS),
    "of numbers": ".".join(["-1"] * (MAX_PARTS + 1)),
}


@pytest.mark.parametrize("place", DEEP.values(), ids=DEEP)
def test_a_key_of_too_many_parts_is_refused_before_it_is_parsed(place, monkeypatch):
    texts = [place.format(key) for key in PARTS.values()]
    assert all(map(tomllib.loads, texts))  # which would grow with the square of the parts
    monkeypatch.setattr("tandemlift.core.files.tomllib", None)
    for text in texts:
        with pytest.raises(InputError, match=f"a key has at most {MAX_PARTS} parts"):
            toml_tables(text)


def test_what_is_no_deep_key_is_read_as_python_reads_it():
    text = f"""\
# ........................................ 1. one, 2. two … and so on and on and on. And on. Until it ends. Or not.
{".".join("a" * MAX_PARTS)} = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7]
text = "… . . . . . . . . . . . . . . . . . . . . . . ../../../../../../../../../../../../../../../../../../x.toml"
[{" . ".join("b" * MAX_PARTS)}]
{".".join("c" * MAX_PARTS)} = 1.5
"""
    assert toml_tables(text) == tomllib.loads(text)


def test_no_key_of_a_mission_has_half_as_many_parts():
    assert max(map(len, keys_of(Mission))) <= MAX_PARTS / 2
