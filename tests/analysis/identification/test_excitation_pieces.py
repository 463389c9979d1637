"""An excitation against closed forms: pushes, lines, limits, promises, information."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.analysis.identification import excitation_information
from tandemlift.analysis.identification.excitation_design import (
    PEAK,
    ExcitationDesign,
    axis_lines,
    excited_tables,
    push_rows,
    used_of,
)
from tandemlift.analysis.identification.identification import Row
from tandemlift.missions import load_mission

RNG = np.random.default_rng(11)


def iris():
    return load_mission("iris")


# excitation


def test_pushes_go_to_and_fro_along_each_axis_and_turn_the_arm_to_the_outermost_quadrotor():
    places = [(0.3, 0.4, 0.0), (-0.1, 0.0, 0.0)]
    rows = push_rows(places, 20.0, 2.0)
    assert [push["time"] for push in rows] == pytest.approx(20.0 + 3.0 * (np.arange(8) + 0.5))
    assert np.array([push["force"] for push in rows[:6]]) == pytest.approx(np.kron(2.0 * np.eye(3), [[1.0], [-1.0]]))
    for push, sign in zip(rows[6:], (1.0, -1.0), strict=True):
        force, point = np.array(push["force"]), np.array(push["point"])
        assert point == pytest.approx([0.15, 0.2, 0.0])
        assert np.linalg.norm(force) == pytest.approx(2.0)
        assert np.cross(point, force)[2] == pytest.approx(-sign * 2.0 * 0.25)  # across the arm
    assert len(push_rows([(0.0, 0.0, 0.0)], 20.0, 2.0)) == 6


@pytest.mark.parametrize("push", [0.0, 2.0])
def test_an_excited_mission_lands_after_its_sines_and_pushes(push):
    t = excited_tables(iris(), 30.0, (2.0, 2.0, 1.0), push)
    begin = t["excitation"]["begin"]
    assert begin >= iris().phases.lift_start + iris().phases.lift_duration + 2.0
    assert len(t["pushes"]) == (8 if push else 0)
    assert t["phases"]["land_start"] == pytest.approx(begin + 30.0 + 2.0 + 3.0 * len(t["pushes"]))
    assert t["mission"]["duration"] >= t["phases"]["land_start"] + iris().phases.land_duration
    for one in t["pushes"]:
        assert begin + 30.0 < one["time"] < t["phases"]["land_start"]


def test_the_phases_of_an_axis_keep_its_peak_low():
    f, A = np.arange(2, 12) / 20.0, np.linspace(1.0, 2.0, 10)
    A[3] = 0.0
    rows = axis_lines("roll", f, A)
    assert [row["frequency"] for row in rows] == pytest.approx(np.delete(f, 3))
    assert [row["amplitude"] for row in rows] == pytest.approx(np.delete(A, 3))
    t = np.linspace(0.0, 20.0, 20_001)
    wave = sum(row["amplitude"] * np.sin(2.0 * np.pi * row["frequency"] * t + row["phase"]) for row in rows)
    assert np.abs(wave).max() < PEAK * math.sqrt((A**2).sum())
    one = [row["amplitude"] * np.sin(2.0 * np.pi * row["frequency"] * t) for row in rows]
    assert np.abs(wave).max() < np.abs(sum(one)).max()


def test_what_a_flight_used_is_its_largest_tilt_thrust_and_speed_and_its_room_until_it_lands():
    t = np.arange(0.0, 10.0, 0.5)
    within = (t >= 3.0) & (t <= 7.0)
    channels = {
        "euler": np.column_stack([0.1 + 0.0 * t, 0.2 * (t == 5.0), 3.0 + 0.0 * t]),
        "rotor_thrusts": np.where(t == 6.0, 4.0, 3.0)[:, None] * np.ones(8),
        "velocity": np.column_stack([0.3 * (t == 4.0), 0.4 * (t == 4.0), 0.0 * t]),
        "position": np.column_stack([t, 0.5 * t, 0.0 * t]),
    }
    for values in channels.values():
        values[~within] += 50.0
    about = {"time": t, "mission": {"excitation": {"begin": 3.0}, "phases": {"land_start": 7.0}}}
    flight = type("Flown", (), {"__getitem__": lambda self, name: channels[name]} | about)()
    limits = {"tilt": 0.5, "rotor thrust": 6.0, "speed": 1.0, **{f"room along {axis}": 9.0 for axis in "xyz"}}
    found = used_of(flight, limits)
    tilt = math.acos(math.cos(0.1) * math.cos(0.2))
    assert [value for value, _ in found.values()] == pytest.approx([tilt, 4.0, 0.5, 4.0, 2.0, 0.0])
    assert [limit for _, limit in found.values()] == list(limits.values())


def test_a_promise_is_in_percent_and_of_delays_and_places_in_thousandths():
    rows = (
        Row("mass", 4.0, 3.98, 4.02, "kg", 4.0, True, 1.0),
        Row("actuators.delay", 0.01, 0.009, 0.011, "s", 0.01, True, 1.0),
        Row("center_of_mass.x", 0.1, 0.098, 0.102, "m", 0.1, False, 1.0),
    )
    said = "\n".join(ExcitationDesign(iris(), rows, {"tilt": (0.1, 0.3)}, "").lines())
    assert "± 0.5 %" in said
    assert "± 1 ms" in said
    assert "± 2 mm, not excited" in said
    assert "0.1 of 0.3 rad" in said


def test_a_heavier_body_looks_like_weaker_rotors_and_one_that_is_late_like_none(monkeypatch):
    """Responses in proportion to 1/mass: their slope by the mass is the opposite of that by the thrust constant."""
    mission, f = iris(), np.array([0.5, 2.0])
    body = RNG.normal(size=(2, 12, 8)) + 1j * RNG.normal(size=(2, 12, 8))
    motion = RNG.normal(size=(2, 12, 8)) + 1j * RNG.normal(size=(2, 12, 8))
    monkeypatch.setattr(
        excitation_information, "body_response", lambda calm, at, frequencies: body / calm.plant.mass_scale
    )
    monkeypatch.setattr(
        excitation_information, "linearize", lambda *_, **__: SimpleNamespace(connected=lambda: "the loop")
    )
    asked = []
    monkeypatch.setattr(
        excitation_information, "frequency_response", lambda model, hertz: asked.append((model, hertz)) or motion
    )
    found = excitation_information.excited_hover(mission, f)
    assert [model for model, _ in asked] == ["the loop"]
    assert np.array_equal(asked[0][1], f)
    names = [p.name for p in excitation_information.PARAMETERS]
    mass, constant = names.index("mass"), names.index("thrust constant")
    I = found.information  # noqa: E741
    assert I[..., mass, mass] == pytest.approx(I[..., constant, constant], rel=3e-3)
    assert I[..., mass, constant] == pytest.approx(-I[..., constant, constant], rel=3e-3)
    assert (I[..., constant, constant] > 0.0).all()
