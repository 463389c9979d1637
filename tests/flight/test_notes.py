"""Notes of a flight: how far ideal actuators go beyond what its quadrotors give."""

import dataclasses
import re

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.pictures.report.flight_report import write_report
from tandemlift.pictures.report.printed_summary import notes, summary_lines

LIMIT = 5.84e-6 * 1100.0**2  # N, of a rotor of an IRIS


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper", {"mission.duration": 30.0, "mission.log_interval": 0.001}))


def test_ideal_actuators_beyond_what_rotors_give_are_noted_with_their_extremes_and_share(paper, tmp_path):
    thrusts = paper["rotor_thrusts"]
    (note,) = notes(paper)
    low, high = (float(x.replace("−", "-").replace(",", "")) for x in re.findall(r"([−+][\d,.]+) (?:to|N)", note))
    assert (low, high) == (pytest.approx(thrusts.min(), abs=0.5), pytest.approx(thrusts.max(), abs=0.5))
    assert low < -1000.0
    beyond = [any(f < 0.0 or f > LIMIT for f in row) for row in thrusts.tolist()]
    (share,) = re.findall(r"in ([\d.]+) % of the logged samples", note)
    assert float(share) == pytest.approx(100.0 * sum(beyond) / len(beyond), rel=5e-3)
    assert f"  note: {note}" in list(summary_lines(paper))
    assert f"Note: {note}." in write_report(paper, [], tmp_path / "report.html").read_text("utf-8")


def test_a_note_is_no_finding_and_leaves_outcome_and_metrics_as_they_are(paper):
    assert list(notes(paper))
    assert not paper.findings
    assert paper.outcome == "flying"
    assert not [name for name in paper.metrics() if "note" in name]


def test_rotors_with_limits_and_ideal_ones_within_them_have_no_note(paper):
    quiet = {"mission.duration": 2.0}
    for flight in (tl.fly(tl.load_mission("hover", quiet)), tl.fly(tl.load_mission("iris", quiet))):
        assert not list(notes(flight))
    held = dataclasses.replace(
        paper, channels={**paper.channels, "rotor_thrusts": np.full((len(paper.time), 8), LIMIT)}
    )
    assert not list(notes(held))


def test_numbers_that_are_none_do_not_hide_the_others(paper):
    broken = paper["rotor_thrusts"].copy()
    broken[5:] = np.nan
    (note,) = notes(dataclasses.replace(paper, channels={**paper.channels, "rotor_thrusts": broken}))
    assert "−1,644 to +2,175 N" in note
    assert not list(notes(dataclasses.replace(paper, channels={"position": paper["position"]})))
