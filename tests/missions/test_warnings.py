"""What may fly badly is told, with the numbers that say why, and flown; what flies well is not."""

import math
import warnings
from itertools import product

import pytest
from for_all import for_all
from hypothesis import given
from hypothesis import strategies as st

import tandemlift as tl
from tandemlift.core.types import leaves
from tandemlift.missions import built_in, load_mission
from tandemlift.parts.contact.feet import sinkage_of, standing_height
from tandemlift.parts.contact.standing import standing_on
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.assemble import assemble

WEAK = [{"quadrotor": 1, "rotor": r, "time": 1.0, "efficiency": 0.1, "known_after": 0.0} for r in (1, 2, 3)]
ALONG = [{"start": [0.2, -3.0], "end": [0.2, 3.0]}]
GUSTS = [{"velocity": [1.0, 0.0, 0.0], "start": 1.0, "rise": 1.0}]
SHORT_LEGS = {f"vehicle.quadrotors.{i}.feet_depth": 0.1 for i in (0, 1)}
UNLIMITED = {"allocation.method": "pseudo-inverse", "observer.model": "none", "detection.model": "none"}
AIR = {"wind.model": "air", "wind.turbulence": 3.0}

TOLD = {  # on top of mission iris
    "a long step": ({"mission.step": 0.005}, ["ground.sinkage = 0.0005 m", "mission.step = 0.005", "0.0029 m"]),
    "feet in the floor": ({"ground.height": -0.133}, ["0.0058 m deep", "up by as much as 0.033 m"]),
    "a start in the air": ({"ground.height": -1.0}, ["0.861 m above the floor", "until 2 s", "0.831 m above where"]),
    "a landing in the air": ({"initial.position": [0.0, 0.0, -0.5]}, ["ends at z = 0, 0.5 m above where"]),
    "a high floor": ({"initial.position": [0.0, 0.0, 1.0]}, ["stands at z = 1 m", "presses down"]),
    "short legs": (SHORT_LEGS, ["the payload hangs 0.025 m lower than the feet"]),
    "a start into the floor": ({"initial.velocity": [0.0, 0.0, -2.3]}, ["= -2.3 m/s", "8.05 N s", "7 N s (crash"]),
    "a start up from the floor": (
        {"initial.velocity": [1.6, 1.6, 1.6]},
        ["= [1.6, 1.6, 1.6] m/s", "9.7 N s", "7 N s ("],
    ),
    "ideal rotors on a floor": (
        {"actuators.model": "ideal", "ground.effect": False},
        ["press the vehicle on the floor"],
    ),
    "a start in a wall": ({"walls": ALONG}, ["quadrotor 1 starts 0.17 m deep in walls.0", "quadrotor 2"]),
    "gusts of no wind": ({"wind.gusts": GUSTS}, ['wind.gusts do not blow while wind.model is "none"']),
    "eddies too low": (AIR | {"wind.height": 1.0}, ["wind.height = 1.0", "3.048 m to 304.8 m", "that of 3.048 m"]),
    "eddies too high": (AIR | {"wind.height": 400.0}, ["wind.height = 400.0", "that of 304.8 m"]),
    "a push in the tare": ({"pushes.0.time": 10.0}, ["the tare, from 9 s to 12 s,", "part of pushes.0 at 10 s"]),
    "a tare in the lift": ({"phases.lift_start": 5.0}, ["begins before the lift ends at 11 s"]),
    "a tare in the landing": ({"phases.land_start": 11.0}, ["ends after the landing begins at 11 s"]),
    "a tare without an end": ({"mission.duration": 11.0}, ["not over before the flight is, at 11 s"]),
    "no tare": (
        {"estimator.tare_start": None, "estimator.identify_mass": False},
        ["sensors.joints.force_bias = 0.3 N is read as a push"],
    ),
    "weak joints": ({"sensors.joints.force_range": 2.0}, ["joint 1 carries 2.453 N in hover", "joint 2"]),
    "a weak accelerometer": ({"sensors.accelerometer.range": 9.0}, ["it reads 9.81 m/s2 in hover"]),
    "a payload of less than nothing": ({"plant.mass_scale": 0.5}, ["plant.mass_scale = 0.5", "-1.25 kg"]),
    "a beam that hangs on one": (
        {"vehicle.quadrotors.0.position": [0.0, 0.1, 0.075], "vehicle.payload.mass": 2.5},
        ["in hover a rotor of quadrotor 1 would give", "can give 0 to 7.066 N"],
    ),
    "too many faults": ({"faults": WEAK, "vehicle.payload.mass": 1.2}, ["weighs 41.2 N", "lift 37.45 N"]),
    "a pilot that cannot use what it knows": (
        {"faults": WEAK[:1], **UNLIMITED},
        ["faults.0.known_after has an effect only if"],
    ),
}

FINE = {
    "two milliseconds": {"mission.step": 0.002},
    "feet just above the floor": {"ground.height": -0.145},
    "a wall beside": {"walls": [{"start": [0.6, -3.0], "end": [0.6, 3.0]}]},
    "gusts of a wind": {"wind.model": "air", "wind.gusts": GUSTS},
    "one rotor less": {"faults": WEAK[:1]},
    "a push after the tare": {"pushes.0.time": 14.0},
    "no bias and no tare": {
        "estimator.tare_start": None,
        "estimator.identify_mass": False,
        "sensors.joints.force_bias": 0.0,
    },
    "the truth and no tare": {"estimator.tare_start": None, "estimator.identify_mass": False, "pilot.push": "truth"},
}


@pytest.mark.parametrize(("changes", "pieces"), TOLD.values(), ids=TOLD)
def test_what_may_fly_badly_is_warned_of(changes, pieces):
    with pytest.warns(tl.FlightWarning) as told:
        load_mission("iris", changes)
    words = "\n".join(str(t.message) for t in told)
    assert [piece for piece in pieces if piece not in words] == []
    assert all(line.startswith("iris: ") for line in words.splitlines())


@pytest.mark.parametrize("changes", FINE.values(), ids=FINE)
def test_what_flies_well_is_not(changes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_mission("iris", changes)


@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"mission.step": 0.005},
        {"plant.mass_scale": 1.2, "plant.inertia_scale": [2.0, 1.0, 1.0]},
        {"ground.height": -0.2, "ground.sinkage": 0.002},
    ],
    ids=str,
)
def test_the_floor_that_is_checked_is_the_one_that_is_flown(changes):
    mission = load_mission("iris", changes)
    standing, flown = standing_of(mission), assemble(mission).model.plant.floor
    assert standing.floor == flown
    assert standing.sinkage == pytest.approx(sinkage_of(flown, mission.hover.weight))
    assert standing.rests == pytest.approx(flown.height + standing_height(flown, mission.hover.weight))


def standing_of(m):
    """How the vehicle of a mission stands on the floor."""
    return standing_on(m.ground, m.vehicle, m.plant.mass_scale, m.mission.step, m.initial)


def test_a_level_vehicle_starts_as_deep_in_its_own_floor_as_it_sinks():
    for changes in ({}, {"mission.step": 0.002}, {"plant.mass_scale": 1.2}):
        standing = standing_of(load_mission("iris", changes))
        assert standing.depth == pytest.approx(0.0, abs=1e-12)
        assert standing.rests == pytest.approx(0.03)


@given(st.floats(-0.016, 0.016), st.sampled_from(["roll", "pitch"]))
def test_a_tilted_start_is_as_deep_as_its_lowest_foot(angle, about):
    """A foot is 0.12 m along x, and 1.12 m along y, from the centre of mass, and 0.169 m below it."""
    euler = [angle, 0.0, 0.7] if about == "roll" else [0.0, angle, 0.7]
    arm, below = 1.12 if about == "roll" else 0.12, 0.18 - 0.075 * 0.5 / 3.5
    depth = arm * math.sin(abs(angle)) - below * (1.0 - math.cos(angle))
    assert told_of("iris", {"initial.euler": euler}).depth == pytest.approx(depth, abs=1e-12)


def told_of(name, changes):
    """How the vehicle stands, whatever is warned of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return standing_of(load_mission(name, changes))


def test_lift_and_weight_are_those_of_the_parts():
    mission = load_mission("iris", {"faults": WEAK, "plant.mass_scale": 1.1})
    most = 5.84e-6 * 1100.0**2
    assert mission.hover.weight == pytest.approx(3.5 * 1.1 * 9.81)
    assert mission.hover.lift == pytest.approx(8 * most)
    assert mission.hover.faulty_lift == pytest.approx((5 + 0.3) * most)


WITHOUT = {"detection.model": "none", "supervision.model": "none"}


@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
@for_all(list(product(built_in(), [{}, {"wind.model": "air"}, UNLIMITED, WITHOUT])))
def test_the_size_of_a_logged_sample_is_that_of_the_log(case):
    mission = load_mission(*case)
    assert mission.sample_size == 8 * (leaves(FlightPlan(mission).sample) + 1)  # and its time
