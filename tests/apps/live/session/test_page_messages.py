"""What a page may say to the live server, and that nothing else gets through."""

import itertools
import json
import math
import re

import pytest
from for_all import for_all
from hostile import GOOD, hostile

from tandemlift.apps.live.session import page_messages as reading
from tandemlift.apps.live.session.page_messages import (
    MAX_FILE_PARTS,
    MAX_LENGTH,
    MAX_PARTS,
    MAX_SIZE,
    PAGE_MESSAGES,
    Refusal,
    read_message,
    subject_of,
)
from tandemlift.missions.reference import template_text

MANY = 10_000


def refused(text) -> Refusal:
    with pytest.raises(Refusal) as caught:
        read_message(text)
    return caught.value


def numbers_in(value):
    """All numbers in nested lists, tuples and dictionaries."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        return [n for item in value for n in numbers_in(item)]
    return [value] if isinstance(value, (int, float)) else []


@pytest.mark.parametrize("message", GOOD, ids=json.dumps)
def test_a_good_message_says_what_was_written(message):
    read = read_message(json.dumps(message)).model_dump(mode="json", exclude_none=True)
    assert read == message


def test_every_kind_of_message_has_an_example():
    assert {message["type"] for message in GOOD} == set(PAGE_MESSAGES)


@for_all(list(itertools.product(GOOD, [math.nan, math.inf, -math.inf, 1e300, [math.nan] * 3, None, {}, [[]]])))
def test_no_key_of_any_message_takes_what_is_not_finite_or_of_another_kind(case):
    message, bad = case
    for key in message:
        if not (key in ("key", "toml") and bad is None):  # as good as left out
            assert str(refused(json.dumps({**message, key: bad})))


@pytest.mark.parametrize(
    ("text", "what", "reason"),
    [
        ("", "message", "no JSON: EOF while parsing a value at line 1 column 0"),
        ("[1]", "message", "[1]: must be a JSON object"),
        ('{"type":"grap"}', "message", "type = \"grap\": must be one of grab, move, .*Did you mean 'grab'\\?"),
        ('{"seq":1}', "message", "type is missing: must be one of grab, move, "),
        ('{"type":"release"}', "release", "release.seq is missing: it must be a whole number ≥ 0"),
        ('{"type":"release","seq":1,"x":2}', "release", "release.x = 2: unknown key; release has seq, type"),
        (
            '{"type":"move","seq":1,"target":[0,NaN,0]}',
            "move",
            "move.target.1 = nan: must be a number ≥ -10000 and ≤ 10000, and finite",
        ),
        ('{"type":"set","seq":1,"key":"wind.velocity","value":NaN}', "set wind.velocity", "set.value = nan: must be "),
        ('{"type":"set","seq":1,"key":"a.b","value":[0,Infinity]}', "set a.b", "set.value = [0, inf]: must be "),
        ('{"type":"set","seq":1,"key":"a b","value":NaN}', "set", "set."),
        ('{"type":"move","seq":1,"target":[0,0]}', "move", "move.target.2 is missing|must be a list of 3"),
        ('{"type":"kill","seq":1,"rotor":-1}', "kill", "kill.rotor = -1: must be a whole number ≥ 0 and ≤ 255"),
        ('{"type":"ask","seq":1,"what":"fly"}', "ask", 'ask.what = "fly": must be "lift", "land" or "stop"'),
        ('{"type":"save","seq":1,"name":".."}', "save", 'save.name = "..": must be 1 to 64 letters, digits'),
        ('{"type":"set","seq":1,"key":"a b","value":1}', "set", 'set.key = "a b": must be a dotted key of 100'),
        (b"{}", "message", "binary data: must be text"),
        (" " * (MAX_LENGTH + 1), "message", f"{MAX_LENGTH + 1} characters: must be {MAX_LENGTH} at most"),
        ("[" * 4000, "message", f"4000 parts: must be {MAX_PARTS} at most"),
        ('{"type":"set","value":[' + "1," * 999 + "1]}", "message", f"1002 parts: must be {MAX_PARTS} at most"),
    ],
)
def test_a_refusal_names_the_key_the_value_and_what_is_allowed(text, what, reason):
    refusal = refused(text)
    assert refusal.what == what
    assert re.search(reason if "\\" in reason or "|" in reason else re.escape(reason), str(refusal)), str(refusal)


@pytest.mark.parametrize("long", [" " * (MAX_LENGTH + 1), '{"x":' * (MAX_PARTS + 1), "0," * (MAX_PARTS + 1)])
def test_what_is_too_long_or_has_too_many_parts_is_refused_before_it_is_parsed(long, monkeypatch):
    monkeypatch.setattr(reading, "_ANY", None)
    monkeypatch.setattr(reading, "from_json", None)
    assert "must be" in str(refused(long))


def test_a_message_with_a_file_may_be_as_long_as_a_page_may_send():
    toml = "# walls\n" * 6_000
    with_file = json.dumps({"type": "fly", "seq": 1, "mission": "mine.toml", "toml": toml}, separators=(",", ":"))
    assert MAX_LENGTH < len(with_file) < MAX_SIZE
    assert read_message(with_file).toml == toml
    assert f"must be {MAX_SIZE} at most" in str(refused(with_file + " " * MAX_SIZE))
    assert f"must be {MAX_LENGTH} at most" in str(refused(json.dumps(json.loads(with_file))))  # it begins otherwise
    assert "12 at most" in str(refused('{"type":"fly",' + ",".join(f'"{i}":1' for i in range(100)) + "}"))


@pytest.mark.parametrize(
    ("many", "most"),
    [
        ('{"type":"fly",' + ",".join(f'"{i}":1' for i in range(5_000)) + "}", MAX_PARTS),
        ('{"type":"fly","toml":[' + "[]," * 9_000 + "[]]}", MAX_PARTS),
        ('{"type":"fly","toml":"\\"' + '[\\"' * 9_000, MAX_FILE_PARTS),  # without an end
        ('{"type":"fly","seq":1,"mission":"a","toml":"' + "a=1\\n" * 5_000 + '"}', MAX_FILE_PARTS),
    ],
)
def test_how_a_message_begins_lifts_no_limit_of_its_parts(many, most, monkeypatch):
    monkeypatch.setattr(reading, "_ANY", None)
    monkeypatch.setattr(reading, "from_json", None)
    assert re.search(f"parts: must be {most} at most", str(refused(many)))


def test_a_mission_with_every_key_has_fewer_parts_than_are_read():
    toml = template_text()
    message = json.dumps({"type": "fly", "seq": 1, "mission": "a", "toml": toml}, separators=(",", ":"))
    assert 4 * sum(map(toml.count, ",[{=")) < MAX_FILE_PARTS * 1.1
    assert len(message) > MAX_SIZE or read_message(message).toml == toml


def test_the_longest_message_has_fewer_parts_and_characters_than_are_read():
    longest = {"type": "set", "seq": 10**15, "key": "x" * 100, "value": [-1.2345678901234567e-300] * 64}
    assert read_message(json.dumps(longest)).value == tuple(longest["value"])


@pytest.mark.parametrize("name", ["../x", "/x", ".x", "-x", "a/b", "a\\b", "a b", "", "a" * 65, "a\n", "ä", "a\0"])
def test_a_name_to_save_under_cannot_lead_elsewhere(name):
    assert "save.name" in str(refused(json.dumps({"type": "save", "seq": 1, "name": name})))


def test_what_a_message_is_about_names_its_key():
    assert subject_of(read_message(json.dumps(GOOD[4]))) == "set admittance.mass"
    assert subject_of(read_message(json.dumps(GOOD[2]))) == "release"


def test_of_many_hostile_messages_those_that_get_through_are_as_good_as_any():
    passed, said = [], []
    for text in hostile(MANY, seed=2):
        try:
            passed.append(read_message(text))
        except Refusal as refusal:
            said.append(str(refusal))
    assert all(0 < len(text) < 500 for text in said)
    assert len(passed) > 50
    for message in passed:
        data = message.model_dump()
        assert read_message(json.dumps(data if data.get("key", "") is not None else {**data, "key": "x"}))
        assert all(abs(n) <= 1e15 for n in numbers_in(data))
