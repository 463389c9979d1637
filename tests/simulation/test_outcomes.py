"""Each outcome and each ending, against what follows from the channels of every step."""

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.simulation.loop.ending import FADING

EVERY = {"mission.log_interval": 0.001}
WATCHED = {"pilot.guidance": "interactive", "supervision.model": "on", "mission.duration": 20.0}
OVER = {"disturbance.moment": [0.0, 9.0, 0.0], "mission.duration": 12.0}
FALL = {"ground.height": -3.0, "phases.rotors": "flight", "phases.lift_start": 5.0, "mission.duration": 4.0}
OUT = WATCHED | {"supervision.fence.high": [0.5, 9.0, 9.0], "disturbance.force": [30.0, 0.0, 0.0]}
ENDED = {
    "over about y": OVER,
    "over about x": OVER | {"disturbance.moment": [60.0, 0.0, 0.0]},
    "fall": FALL,
    "out": OUT,
}


@pytest.fixture(scope="module")
def flown():
    """Flights of `iris`, alone, with every step."""
    kept = {name: tl.fly(tl.load_mission("iris", changes | EVERY)) for name, changes in ENDED.items()}
    return kept.__getitem__


def tilt_of(flight):
    rotation = Rotation.from_quat(flight["attitude"], scalar_first=True)
    return np.degrees(np.arccos(rotation.as_matrix()[:, 2, 2]))


@pytest.mark.parametrize("name", ["over about y", "over about x"])
def test_a_vehicle_that_turns_over_ends_at_89_degrees_about_whichever_axis(name, flown):
    flight, tilt = flown(name), tilt_of(flown(name))
    assert (flight.outcome, flight.ending.quantity) == ("crashed", "tilt [deg]")
    assert tilt.max() < 89.0 < flight.ending.value < 91.0
    assert flight.ending.value == pytest.approx(2.0 * tilt[-1] - tilt[-2], abs=0.02)  # a step after the last sample


def test_a_vehicle_that_falls_ends_where_it_strikes(flown):
    flight = flown("fall")
    assert (flight.outcome, flight.ending.quantity) == ("crashed", "impulse of contact [N s]")
    force, weight = flight["contact_force"], 3.5 * 9.81
    beyond = np.linalg.norm(np.column_stack([force[:, :2], np.maximum(force[:, 2] - weight, 0.0)]), axis=1)
    impulse = lfilter([0.001], [1.0, -(1.0 - 0.001 / FADING)], beyond)
    assert impulse[-2] < 7.0 <= impulse[-1]
    assert flight.ending.value == pytest.approx(impulse[-1], rel=1e-9)
    assert flight["position"][-1, 2] < -2.5
    assert str(flight.ending) == f"crashed at {flight.ending.time:.6g} s: hit the floor: {impulse[-1]:.3g} of 7 N s"


def test_a_vehicle_that_leaves_the_fence_ends_a_metre_outside(flown):
    flight = flown("out")
    assert (flight.outcome, flight.ending.quantity) == ("crashed", "distance outside the fence [m]")
    assert flight["position"][-1, 0] < 1.5 < flight.ending.value + 0.5 < 1.51


def test_a_flight_that_flies_on_ends_at_rest_and_counts_until_the_crash(flown):
    crash = flown("over about y")
    after = tl.fly(tl.load_mission("iris", OVER | EVERY | {"crash.fly_on": 10.0}))
    assert after.ending == crash.ending
    assert len(after.time) > len(crash.time) + 500
    assert after["rotor_thrusts"][-1].max() < 1e-6
    until = {"position_rmse_m", "position_max_error_m", "human_work_j", "rotor_saturated_share"}
    assert {k: after.metrics()[k] for k in until} == {k: crash.metrics()[k] for k in until}


@pytest.mark.parametrize(
    ("name", "changes", "outcome"),
    [
        ("iris", {}, "landed"),
        ("iris", {"mission.duration": 30.0}, "flying"),
        ("iris", {"disturbance.force": [0.0, 0.0, -30.0], "mission.duration": 9.0}, "not-lifted"),
        ("iris", {"disturbance.force": [0.0, 0.0, -30.0], "mission.duration": 3.0}, "landed"),
        ("hover", {"initial.rates": [1e200, 1e200, 1e200]}, "diverged"),
    ],
)
@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
def test_the_outcome_is_that_of_the_definitions(name, changes, outcome):
    assert tl.fly(tl.load_mission(name, changes)).outcome == outcome


@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
def test_a_record_asked_for_on_the_way_knows_nothing_of_a_landing_to_come():
    sim = tl.Simulation(tl.load_mission("paper", {"initial.euler": 0.0, "initial.position": 0.0, "pushes": []}))
    for _ in range(2000):
        sim.step()
    flight = sim.flight()
    assert flight.outcome == "flying"
    assert not flight.findings
