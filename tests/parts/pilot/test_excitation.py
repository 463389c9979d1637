"""The excitation of a flight: sums of sines by NumPy, the response of a rigid body, limits, refusals."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import Absent, Vec3
from tandemlift.missions import check, load_mission, tables_of
from tandemlift.missions.facts import Facts
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.pilot.excitation import AXES, ExcitationTable, excited, excited_lead, start_excitation


def line(axis, frequency, amplitude, phase=0.0):
    return {"axis": axis, "frequency": frequency, "amplitude": amplitude, "phase": phase}


LINES = [line(axis, 0.4 + 0.3 * i, 0.1 + 0.2 * i, 0.5 * i) for i, axis in enumerate(AXES)] + [line("yaw", 1.7, 0.3)]
TABLE = ExcitationTable.model_validate(
    {"model": "multisine", "begin": 3.0, "duration": 9.0, "ramp": 1.0, "lines": LINES}
)
U = Wrench(30.0, Vec3(0.1, 0.2, 0.3))
HOVER = {  # ideal rotors, the pilot reads the truth
    "mission.duration": 30.0,
    "phases.land_start": 40.0,
    "excitation.model": "multisine",
    "excitation.begin": 8.0,
    "excitation.duration": 20.0,
}


def plain(axis, t):
    """The sum of sines of an axis by NumPy, in its window: 1 between the ramps, 0 outside."""
    s = t - TABLE.begin
    total = sum(
        row["amplitude"] * np.sin(2 * np.pi * row["frequency"] * s + row["phase"])
        for row in LINES
        if row["axis"] == axis
    )
    ramp = np.clip(np.minimum(s / TABLE.ramp, (TABLE.duration - TABLE.ramp - s) / TABLE.ramp), 0.0, 1.0)
    return total * np.polyval([6.0, -15.0, 10.0, 0.0, 0.0, 0.0], ramp)


def test_the_wrench_gains_the_sum_of_its_lines_in_flight_alone():
    k = start_excitation(TABLE)
    for t in np.linspace(0.0, 14.0, 113).tolist():
        u = excited(k, U, 1.0, t)
        added = np.array([u.thrust - U.thrust, *(u.moment - U.moment)])
        assert added == pytest.approx([plain(axis, t) for axis in ("thrust", "roll", "pitch", "yaw")], abs=1e-12)
        assert excited(k, U, 0.0, t) == U


def test_the_reference_is_given_the_velocity_of_its_lines_and_comes_to_rest_where_it_began():
    k, h = start_excitation(TABLE), 1e-3
    times = np.arange(0.0, 14.0, h)
    given = [excited_lead(k, Absent(), t) for t in (times + 0.5 * h).tolist()]
    travelled = np.cumsum([list(lead.velocity) for lead in given], axis=0) * h
    for i, axis in enumerate("xyz"):
        assert travelled[:, i] == pytest.approx(plain(axis, times + h), abs=1e-4)
    assert np.abs(travelled[-1]).max() < 1e-6
    assert [lead.given for lead in given] == [float(3.0 <= t < 12.0) for t in times + 0.5 * h]


def test_outside_its_window_the_reference_has_a_callers_velocity():
    k, callers = start_excitation(TABLE), ReferenceVelocity(Vec3(1.0, 2.0, 3.0), 1.0)
    assert excited_lead(k, callers, 2.0) == callers
    assert excited_lead(k, callers, 7.0) == excited_lead(k, Absent(), 7.0)


def test_an_absent_excitation_changes_nothing():
    k = Facts(load_mission("hover")).started("pilot")[0]["excitation"]
    assert k == Absent()
    assert excited(k, U, 1.0, 5.0) is U
    assert excited_lead(k, Absent(), 5.0) == Absent()
    wrench_only = start_excitation(TABLE.model_copy(update={"lines": (TABLE.lines[1],)}))
    assert excited_lead(wrench_only, Absent(), 5.0) == Absent()


@pytest.fixture(scope="module")
def shaken():
    """A hover of the paper's vehicle, excited far above the bandwidth of its loops, and slowly along x."""
    lines = [
        line("roll", 8.0, 3.0),
        line("pitch", 9.0, 0.4),
        line("yaw", 7.0, 0.5),
        line("thrust", 6.0, 4.0),
        line("x", 0.2, 0.3),
    ]
    return tl.fly(load_mission("hover", HOVER | {"excitation.lines": lines})), lines


def test_a_fast_moment_turns_the_vehicle_as_it_turns_a_free_body(shaken):
    """Rate amplitude A/(J ω), speed amplitude A/(m ω): the controller cannot follow, by a few per cent."""
    flight, lines = shaken
    within = (flight.time > 10.0) & (flight.time < 25.0)
    t, vehicle = flight.time[within], load_mission("hover").hover.vehicle
    inertia = dict(zip(("roll", "pitch", "yaw"), np.diag(vehicle.inertia), strict=True)) | {"thrust": vehicle.mass}
    moved = dict(zip(("roll", "pitch", "yaw"), flight["rates"][within].T, strict=True))
    moved["thrust"] = flight["velocity"][within][:, 2]
    for one in lines[:4]:
        omega = 2.0 * np.pi * one["frequency"]
        amplitude = 2.0 * np.abs(np.mean(moved[one["axis"]] * np.exp(-1j * omega * t)))
        assert amplitude == pytest.approx(one["amplitude"] / (inertia[one["axis"]] * omega), rel=0.08)


def test_the_reference_moves_as_far_as_its_line_says_and_the_vehicle_returns(shaken):
    flight, _ = shaken
    x = flight["reference_position"][:, 0]
    assert np.ptp(x[(flight.time > 10.0) & (flight.time < 25.0)]) == pytest.approx(0.6, rel=0.05)
    assert abs(flight["position"][-1, 0] - flight["position"][np.searchsorted(flight.time, 8.0), 0]) < 0.02
    assert np.ptp(flight["reference_position"][flight.time > 27.0], axis=0) == pytest.approx([0.0] * 3, abs=2e-3)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"excitation.lines": []}, "excitation.model"),
        ({"excitation.begin": 0.5}, "excitation.begin = 0.5: must be at least"),
        ({"excitation.duration": 25.0}, "excitation.duration = 25: must be at most 22 s"),
        ({"excitation.ramp": 7.0}, "excitation.ramp = 7: must be at most 6.66667 s"),
        ({"excitation.lines.0.frequency": 0.04}, "excitation.lines.0.frequency = 0.04: must be at least 0.05 Hz"),
        ({"excitation.lines.0.frequency": 500.0}, "excitation.lines.0.frequency = 500: must be at least"),
    ],
)
def test_an_impossible_excitation_is_refused_with_its_key(keys, words):
    with pytest.raises(tl.InputError, match=words):
        load_mission("hover", HOVER | {"excitation.lines": [line("yaw", 1.0, 0.1)]} | keys)


@pytest.mark.parametrize(
    ("one", "subject"),
    [
        (line("thrust", 2.0, 1000.0), "thrust"),
        (line("pitch", 0.5, 0.6), "tilt"),
        (line("x", 0.1, 1.5), "room along x"),
        (line("thrust", 0.2, 4.0), "room along z"),
    ],
)
def test_an_excitation_beyond_a_limit_fails_its_check(one, subject):
    tables = tables_of(load_mission("iris", {"pushes": []}))
    tables["phases"]["land_start"] = 50.0
    tables["excitation"] = {"model": "multisine", "begin": 14.0, "duration": 30.0, "lines": [one]}
    mission = check(tables, "beyond", quiet=True)
    failed = [r.subject for r in flight_checks(mission) if r.check == "excitation" and r.verdict == "fails"]
    assert subject in failed
