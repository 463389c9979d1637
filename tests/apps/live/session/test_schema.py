"""The wire is defined once: what is written from the definitions is up to date, and what is sent keeps to them."""

import json
import types
from typing import Annotated, Literal, NotRequired, Union, get_args, get_origin, get_type_hints, is_typeddict

import pytest
import wire_types
from reference_tables.messages import frame, page_messages, scene, server_messages, status

import tandemlift as tl
from tandemlift.apps.live.replay import scene_and_frames
from tandemlift.apps.live.session.frames import FRAME_FIELDS, layout_for
from tandemlift.apps.live.session.page_messages import PAGE_MESSAGES
from tandemlift.apps.live.session.server_messages import (
    SERVER_MESSAGES,
    SHOWN_PARAMETERS,
    FlightScene,
    FlightStatus,
    OneOf,
)
from tandemlift.apps.live.session.session import Session
from tandemlift.missions import built_in


def breaks(value, hint, at="message"):
    """Where a value does not keep to an annotation; read from the annotation, without the tool's reading of it."""
    origin, parts = get_origin(hint), get_args(hint)
    if origin in (Annotated, NotRequired):
        marks = [mark for mark in parts[1:] if isinstance(mark, OneOf)]
        wrong = [f"{at} = {value!r}" for mark in marks if value not in mark.options]
        return wrong + breaks(value, parts[0], at)
    if origin in (Union, types.UnionType):
        return [] if any(not breaks(value, part) for part in parts) else [f"{at} = {value!r}"]
    if origin is Literal:
        return [] if value in parts else [f"{at} = {value!r}"]
    if origin is list:
        whole = [] if isinstance(value, list) else [f"{at} is no list"]
        return whole or [wrong for i, one in enumerate(value) for wrong in breaks(one, parts[0], f"{at}.{i}")]
    if origin is tuple:
        whole = [] if isinstance(value, list) and len(value) == len(parts) else [f"{at} is no list of {len(parts)}"]
        pairs = zip(value, parts, strict=True) if not whole else ()
        return whole or [wrong for i, (one, part) in enumerate(pairs) for wrong in breaks(one, part, f"{at}.{i}")]
    if is_typeddict(hint):
        return breaks_table(value, hint, at)
    kinds = {float: (int, float), int: int, str: str, bool: bool, type(None): type(None)}
    good = isinstance(value, kinds[hint]) and (hint is bool or not isinstance(value, bool))
    return [] if good else [f"{at} = {value!r} is no {hint.__name__}"]


def breaks_table(value, hint, at):
    if not isinstance(value, dict):
        return [f"{at} = {value!r} is no object"]
    hints = get_type_hints(hint, include_extras=True)
    wrong = [f"{at}.{key}: unknown" for key in value.keys() - hints.keys()]
    for key, one in hints.items():
        if key in value:
            wrong += breaks(value[key], one, f"{at}.{key}")
        elif get_origin(one) is not NotRequired:
            wrong.append(f"{at}.{key}: missing")
    return wrong


def as_sent(message):
    return json.loads(json.dumps(message, allow_nan=False))


def test_the_types_of_the_page_are_those_of_the_definitions():
    assert wire_types.TYPESCRIPT.read_text("utf-8") == wire_types.page_types(), "run: python tools/wire_types.py"


def test_every_message_key_and_field_is_in_the_tables():
    tables = "".join(table() for table in (page_messages, server_messages, scene, status, frame))
    for name, kind in {**PAGE_MESSAGES, **SERVER_MESSAGES}.items():
        for key in get_type_hints(kind).keys() - {"type", "seq", "model_config"}:
            if not key.startswith(("model_", "_")):
                assert f"`{key}`" in tables, (name, key)
    for field in FRAME_FIELDS:
        assert f"| `{field.name}` |" in tables


@pytest.mark.parametrize("name", built_in())
def test_the_scene_and_the_status_of_every_mission_keep_to_the_definitions(name):
    session = Session(tl.load_mission(name))
    scene, status = as_sent(session.scene), as_sent(session.status())
    assert breaks(scene, FlightScene, "scene") == []
    assert breaks(status, FlightStatus, "status") == []
    assert scene["fields"] == as_sent(layout_for(4 * len(scene["vehicle"]["quadrotors"])))


def test_the_status_of_a_flight_and_the_scene_of_a_replay_keep_to_the_definitions(tmp_path):
    session = Session(tl.load_mission("hover"), out=tmp_path)
    session.prepare()
    assert breaks(as_sent(session.status()), FlightStatus) == []
    scene, _ = scene_and_frames(tl.fly(tl.load_mission("one-push", {"mission.duration": 1.0})))
    assert breaks(as_sent(scene), FlightScene) == []
    assert "replay" in scene


def test_what_does_not_keep_to_the_definitions_is_found():
    scene = as_sent(Session(tl.load_mission("zigzag")).scene)
    wrong = {"floor": "0", "phases": ["asleep"], "walls": [{"center": [0, 0, 0]}], "fields": [["time"]]}
    for key, value in wrong.items():
        assert breaks({**scene, key: value}, FlightScene), key
    assert breaks({**scene, "more": 1}, FlightScene) == ["message.more: unknown"]
    assert breaks({k: v for k, v in scene.items() if k != "spring"}, FlightScene) == ["message.spring: missing"]


def test_the_parameters_that_the_page_shows_can_be_changed():
    keys = {parameter["key"] for parameter in Session(tl.load_mission("hover")).scene["parameters"]}
    assert set(SHOWN_PARAMETERS.values()) <= keys
