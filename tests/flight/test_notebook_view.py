"""A flight and a mission in a notebook: the table says what the record says, and the picture is to scale."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from html_page import Page

import tandemlift as tl

MOST = 60_000  # bytes


@pytest.fixture(scope="module")
def flight():
    return tl.fly(tl.load_mission("one-push"))


def shown(flight):
    page = Page(flight._repr_html_())
    if page.amiss or page.open:
        raise ValueError(f"tags not closed: {page.amiss}, {page.open}")
    return dict(page.rows)


def picture(flight):
    (text,) = re.findall(r"<svg.*</svg>", flight._repr_html_(), re.DOTALL)
    return ElementTree.fromstring(text)


def lines(flight, look):
    """The points (n, 2) [px] of the picture's lines whose style has some text."""
    found = [e.get("d") for e in picture(flight).iter() if e.tag.endswith("path") and look in e.get("style", "")]
    points = [np.array(re.findall(r"[ML] (\S+) (\S+)", d), float) for d in found]
    return [line for line in points if len(line) > 1]


def test_the_table_says_what_the_record_says(flight):
    rows = shown(flight)
    assert rows["mission"] == "one-push"
    assert rows["engine"] == "compiled"
    assert rows["flown"] == "12 s, 1,201 samples"
    assert rows["outcome"] == "✓ flying"
    assert rows["findings"] == "none"
    assert rows["final position"] == f"{flight['position'][-1, 0]:.3g}, 0, 0 m"
    assert rows["work of the person"] == f"{flight.metrics()['human_work_j']:.3g} J"


def test_the_path_is_to_scale_and_runs_from_left_to_right(flight):
    path, _ = lines(flight, "stroke: #2a8bcc; stroke-width: 1.")
    beam, _ = lines(flight, "stroke-opacity: 0.55")
    metres = flight.mission["vehicle"]["payload"]["length"] / np.linalg.norm(beam[1] - beam[0])
    length = np.linalg.norm(path[-1] - path[0]) * metres
    assert length == pytest.approx(np.linalg.norm(flight["position"][-1] - flight["position"][0]), rel=0.01)
    assert path[-1, 0] > path[0, 0]


def test_push_and_error_have_their_peaks_written_beside_them(flight):
    texts = [e.text for e in picture(flight).iter() if e.tag.endswith("text")]
    error = 1e3 * np.linalg.norm(flight["position_error"], axis=1).max()
    assert "push, at most 3 N" in texts
    assert f"position error, at most {error:.3g} mm" in texts


def test_it_needs_nothing_else_and_is_small(flight):
    html = flight._repr_html_()
    assert len(html.encode()) < MOST
    assert not re.search(r"href=\"[^#]|src=|<script|url\([^#]|#000|#fff|black|white\"", html)


def test_a_crash_and_its_findings_are_shown():
    crashed = tl.fly(tl.load_mission("paper", {"actuators.model": "rotors"}))
    rows = shown(crashed)
    assert rows["outcome"].startswith("✗ crashed at 3.05")
    assert rows["findings"] == "saturated at 0 s"
    assert len(lines(crashed, "stroke: #2a8bcc; stroke-width: 1.")) == 2


def test_names_are_no_markup(flight):
    odd = replace(flight, version={"engine": "<b>"})
    assert shown(odd)["engine"] == "<b>"


def with_channels(flight, **channels):
    return replace(flight, channels={**flight.channels, **channels})


def empty(flight):
    return replace(flight, time=flight.time[:0], channels={k: v[:0] for k, v in flight.channels.items()}, results={})


ODD = {
    "nothing logged": empty,
    "one sample": lambda f: replace(f, time=f.time[:1], channels={k: v[:1] for k, v in f.channels.items()}),
    "no channels": lambda f: replace(f, channels={}, results={}),
    "position alone": lambda f: replace(f, channels={"position": f["position"]}),
    "not finite": lambda f: with_channels(f, **{k: v * np.nan for k, v in f.channels.items()}),
    "infinite push": lambda f: with_channels(f, push_force=f["push_force"] * np.inf),
    "huge": lambda f: with_channels(f, position=f["position"] * 1e300, reference_position=f["position"] * 1e305),
    "at rest": lambda f: with_channels(f, position=f["position"] * 0.0, reference_position=f["position"] * 0.0),
    "metrics that could not be formed": lambda f: replace(
        f, results={**dict.fromkeys(f.results), "outcome": f.outcome}
    ),
    "a mission that says nothing": lambda f: replace(f, mission={"mission": {"name": "bare"}}),
}


@pytest.mark.parametrize("odd", ODD.values(), ids=ODD)
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_no_flight_is_too_odd_to_be_shown(odd, flight):
    assert shown(odd(flight))["mission"]


def test_walls_are_in_the_picture_of_a_corridor():
    zigzag = tl.fly(tl.load_mission("zigzag", {"mission.duration": 0.1}))
    assert len(lines(zigzag, "stroke: #8c8c8c")) >= 2


def test_a_mission_shows_its_choices():
    page = Page(tl.load_mission("iris")._repr_html_())
    assert page.amiss == []
    rows = dict(page.rows)
    assert rows["mission"] == "iris, 90 s in steps of 1 ms"
    assert rows["vehicle"] == "2 quadrotors on a payload of 0.5 kg; 3.5 kg in all"
    assert rows["rotors"] == "rotors, constrained"
