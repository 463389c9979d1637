"""What may fly badly is warned of when a mission is loaded, with numbers and key; what flies well is not.

Most rows were once loaded without a word, flown, and ended badly.
"""

import numpy as np
import pytest
from for_all import for_all
from validation.scenarios import BASE, WINDY
from warned import warnings_of

import tandemlift as tl
from tandemlift.missions import load_mission, tables_of

IRIS = tables_of(load_mission("iris"))["vehicle"]["quadrotors"]
WEAK = [{"quadrotor": 1, "rotor": r, "time": 1.0, "efficiency": 0.1, "known_after": 0.0} for r in (1, 2, 3)]
ALONG = [{"start": [0.2, -3.0], "end": [0.2, 3.0]}]
BESIDE = [{"start": [0.6, -3.0], "end": [0.6, 3.0]}]
SHORT_LEGS = {f"vehicle.quadrotors.{i}.feet_depth": 0.1 for i in (0, 1)}
UNLIMITED = {"allocation.method": "pseudo-inverse", "observer.model": "none", "detection.model": "none"}
REAL, IDEAL = {"actuators.model": "rotors"}, {"actuators.model": "ideal", "ground.effect": False}
NO_TARE = {"estimator.tare_start": None, "estimator.identify_mass": False}
IN_THE_AIR = {"ground.model": "none", "ground.effect": False, "phases.rotors": "always"}
COMPENSATED = {"estimator.wind_compensation": "quadrotors"}
STEER = {"person.model": "steer", "person.path": [{"point": [1.0, 0.0]}], "person.start_time": 2.0}


def all_fail(time):
    """Every rotor fails at a time [s]; a flight that was flown by hand is saved with a fault that never comes."""
    both = [(q, r) for q in (1, 2) for r in (1, 2, 3, 4)]
    return {"faults": [{"quadrotor": q, "rotor": r, "time": time, "efficiency": 0.0} for q, r in both]}


def rotors(**factors):
    """The rotors of iris, with numbers of them multiplied."""
    return {"vehicle.quadrotors": [{**q, **{name: q[name] * f for name, f in factors.items()}} for q in IRIS]}


def push(force, **keys):
    return {"pushes": [{"time": 15.0, "sigma": 0.6, "force": force} | keys]}


def wind(x, y, **keys):
    return {"wind.model": "air", "wind.velocity": [x, y, 0.0], **keys}


def gusts(*rows):
    keys = ("velocity", "start", "rise", "hold")
    return {"wind.model": "air", "wind.gusts": [dict(zip(keys, row, strict=False)) for row in rows]}


SHORT = {  # the largest force is more than the rotors counter, the speed that it leaves is small
    "10 N for 10 ms": push([10.0, 0.0, 0.0], sigma=0.01),
    "20 N for 50 ms": push([20.0, 0.0, 0.0], sigma=0.05),
    "9.5 N for 0.3 s": push([9.5, 0.0, 0.0], sigma=0.3),
    "30 N up at an end for 10 ms": push([0.0, 0.0, 30.0], sigma=0.01, point=[0.0, 1.0, 0.0]),
    "30 N down for 10 ms": push([0.0, 0.0, -30.0], sigma=0.01),
}
TAPS = {"pushes": [SHORT["20 N for 50 ms"]["pushes"][0] | {"time": 15.0 + 0.1 * i} for i in range(8)]}
AIR, ROUGH = {"wind.model": "air", "wind.turbulence": 3.0}, {"wind.turbulence": 7.7}
X2, X4 = [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]
HEARD = "turbulence pushes the payload along x"
BLOWN = "wind and gusts push the payload along x with"
TOLD = {  # of mission iris: changes, and what the warnings must say of them
    # how it stands and starts
    "a long step": ({"mission.step": 0.005}, ["ground.sinkage = 0.0005 m", "mission.step = 0.005", "0.0029 m"]),
    "feet in the floor": ({"ground.height": -0.133}, ["0.0058 m deep", "up by as much as 0.033 m"]),
    "a start in the air": ({"ground.height": -1.0}, ["0.861 m above the floor", "until 2 s", "0.831 m above where"]),
    "a landing in the air": ({"initial.position": [0.0, 0.0, -0.5]}, ["ends at z = 0, 0.5 m above where"]),
    "a high floor": ({"initial.position": [0.0, 0.0, 1.0]}, ["stands at z = 1 m", "presses down"]),
    "short legs": (SHORT_LEGS, ["the payload hangs 0.025 m lower than the feet"]),
    "a start into the floor": ({"initial.velocity": [0.0, 0.0, -2.3]}, ["= -2.3 m/s", "8.05 N s", "7 N s (crash"]),
    "a start up from the floor": ({"initial.velocity": [1.6] * 3}, ["= [1.6, 1.6, 1.6] m/s", "9.7 N s", "7 N s ("]),
    "ideal rotors on a floor": (IDEAL, ["press the vehicle on the floor"]),
    "a start in a wall": ({"walls": ALONG}, ["quadrotor 1 starts 0.17 m deep in walls.0", "quadrotor 2"]),
    "speed": ({"initial.velocity": [50.0, 0.0, 0.0]}, ["speed of 50 m/s", "lower it to 5 m/s"]),
    "rates": ({"initial.rates": [0.0, 0.0, 50.0]}, ["yaw rate of 50 rad/s", "20 rad/s or less"]),
    "rates in the air": (
        IN_THE_AIR | {"initial.rates": [3.0, 0.0, 0.0]},
        ["roll rate of 3 rad/s", "lower it to 2."],
    ),
    # wind
    "gusts of no wind": (
        {**gusts((X2, 1.0, 1.0)), "wind.model": "none"},
        ["wind.gusts.0.start", 'where wind.model = "air"'],
    ),
    "eddies too low": (AIR | {"wind.height": 1.0}, ["wind.height = 1.0", "3.048 m to 304.8 m", "that of 3.048 m"]),
    "eddies too high": (AIR | {"wind.height": 400.0}, ["wind.height = 400.0", "that of 304.8 m"]),
    "wind along x": (wind(4.0, 0.0, **ROUGH), [HEARD, "admittance.threshold is 0.3 N", "controller.max_tilt = 0.25"]),
    "wind along -y": (wind(0.0, -4.0, **ROUGH), [HEARD, "estimator.wind_compensation"]),
    "a gust that stays": (gusts((X2, 20.0, 0.5)), [BLOWN, "0.539 N", "admittance.threshold is 0.3 N"]),
    "a gust over the tare": (gusts((X2, 8.0, 0.5, 6.0)), [BLOWN, "0.539 N"]),
    "a gust upwards": (gusts(([0.0, 0.0, 2.0], 20.0, 0.5)) | COMPENSATED, ["along z with 0.539 N"]),
    "wind that is not tared": (wind(2.0, 0.0) | NO_TARE, [BLOWN, "0.539 N"]),
    "wind and a push beyond the tilt": (  # of 20 such flights one is carried away by 3 m
        {**BASE, **WINDY, "mission.seed": 913},
        ["make 9.68 N across, and controller.max_tilt = 0.25 can counter 8.77"],
    ),
    # tare and sensors
    "a push in the tare": ({"pushes.0.time": 10.0}, ["the tare, from 9 s to 12 s,", "part of pushes.0 at 10 s"]),
    "a tare in the lift": ({"phases.lift_start": 5.0}, ["begins before the lift ends at 11 s"]),
    "a tare in the landing": ({"phases.land_start": 11.0}, ["ends after the landing begins at 11 s"]),
    "a tare without an end": ({"mission.duration": 11.0}, ["not over before the flight is, at 11 s"]),
    "no tare": (NO_TARE, ["sensors.joints.force_bias = 0.3 N is read as a push"]),
    "weak joints": ({"sensors.joints.force_range": 2.0}, ["joint 1 carries 2.453 N in hover", "joint 2"]),
    "a weak accelerometer": ({"sensors.accelerometer.range": 9.0}, ["it reads 9.81 m/s2 in hover"]),
    "noise above the threshold": ({"sensors.joints.force_noise": 1.0}, ["noise is followed as a push"]),
    "a motion sensor too slow": (
        {"sensors.motion.interval": 2.0},
        ["sensors.motion.interval = 2 s", "make more than 0.167 s"],
    ),
    "a motion sensor too late": ({"sensors.motion.delay": 0.2}, ["sensors.motion.delay = 0.2 s"]),
    "joints too slow": (
        {"sensors.interval": 1.0, "pilot.state": "truth"},
        ["sensors.interval = 1 s", "make more than 0.1 s"],
    ),
    # rotors and weight
    "a payload of less than nothing": ({"plant.mass_scale": 0.5}, ["plant.mass_scale = 0.5", "-1.25 kg"]),
    "a beam that hangs on one": (
        {"vehicle.quadrotors.0.position": [0.0, 0.1, 0.075], "vehicle.payload.mass": 2.5},
        ["in hover a rotor of quadrotor 1 would give", "can give 0 to 7.066 N"],
    ),
    "a weight off the centre": ({"plant.center_of_mass_offset": [0.0, 0.7, 0.0]}, ["in hover a rotor of quadrotor 1"]),
    "too many faults": ({"faults": WEAK, "vehicle.payload.mass": 1.2}, ["weighs 41.2 N", "lift 37.45 N"]),
    "all rotors fail": (all_fail(60.0), ["its rotors lift"]),
    "a pilot that cannot use what it knows": (
        {"faults": WEAK[:1], **UNLIMITED},
        ["faults.0.known_after has an effect only if"],
    ),
    "delay 0.1 s": ({"actuators.delay": 0.1}, ["the z loop tolerates 5", "actuators.delay = 0.1 s", "102 ms"]),
    "lag 0.5 s": (rotors(lag_up=40.0, lag_down=20.0), ["oscillates with the rotors' lag of 500 ms", "lag_up"]),
    "slow and late": (rotors(lag_up=4.0, lag_down=4.0) | {"actuators.delay": 0.03}, ["tolerates 2", "31.5 ms"]),
    "weak rotors": (rotors(thrust_constant=0.65), ["34.3 N", "compliance.thrust_fraction = 0.9", "33.1 N"]),
    "an unknown yaw moment": ({"disturbance.moment": [0.0, 0.0, 3.0]}, ["yaw moment of 3 N m", "disturbance.moment"]),
    "30 N downwards": ({"disturbance.force": [0.0, 0.0, -30.0]}, ["64.3 N", "56.5 N", "cannot fly"]),
    "no switching": ({"controller.gains.lambda_2": 0.0}, ["controller.gains.lambda_2 is 0 along x, y, z"]),
    # pushes, phases and what is promised
    "a push of 30 N downwards": (push([0.0, 0.0, -30.0]), ["in pushes.0, hover needs 64.3 N", "on the floor"]),
    "a push into the floor": (push([0.0, 0.0, -5.0]), ["pushes.0 moves the reference down", "phases.height = 1 m"]),
    "a push that turns over": (push([10.0, 0.0, 0.0], point=[0.0, 0.0, 0.5]), ["pitch moment of 5 N m"]),
    "a push that carries away": (push([15.0, 0.0, 0.0]), ["15 N across", "controller.max_tilt"]),
    "many taps": (TAPS, ["in pushes.", "N across", "controller.max_tilt"]),
    "a tap too hard": (push([60.0, 0.0, 0.0], sigma=0.06), ["60 N across", "the vehicle is carried away"]),
    "a push that goes on too long": (push([9.5, 0.0, 0.0], sigma=0.7), ["9.5 N across", "controller.max_tilt"]),
    "a push in the lift": (push([3.0, 0.0, 0.0], time=5.0), ["pushes.0 has its peak at 5 s", "12 s"]),
    "a push in the air": (push([0.0, 0.0, 1.0], point=[0.0, 1.6, 0.0]), ["is 0.22 m beside the vehicle"]),
    "a push below the threshold": (
        push([0.2, 0.0, 0.1]),
        ["pushes.0 has 0.2 N along x", "admittance.threshold is 0.3 N", "it is ignored"],
    ),
    "a lift in no time": ({"phases.lift_duration": 0.01}, ["phases.lift_duration = 0.01 s", "0.95 s or more"]),
    "a landing too late": ({"phases.land_start": 85.0}, ["takes until 97 s", "mission.duration is 90 s"]),
    "a supervision that refuses": (
        {"supervision.model": "on", "supervision.checks.thrust_fraction": 0.6},
        ["supervision.checks.thrust_fraction = 0.6", "the lift is refused"],
    ),
    "a person in the tare": (
        {**STEER, "pilot.guidance": "scheduled"},
        ["person.start_time = 2.0 is before the tare ends at 12 s", "landing request of [person] has no effect"],
    ),
    "a small RMS": ({"promise.rms_distance": 0.001}, ["rms_distance = 0.001 cannot be kept", "motion.position_noise"]),
    "a small heading": ({"promise.heading": 1e-4}, ["heading = 0.0001 cannot be kept", "motion.attitude_noise"]),
    "a small distance": ({"promise.distance": 0.02}, ["distance = 0.02 cannot be kept", "compliance.touchdown_depth"]),
}
TOLD_OF_OTHERS = [
    ("paper", {"initial.velocity": [0.0, 30.0, 40.0]}, ["speed of 50 m/s", "lower it to 10 m/s"]),
    ("paper", {"phases.lift_duration": 0.01}, ["100 m/s² can be flown"]),
    ("paper", {"phases.land_duration": 0.01}, ["phases.land_duration = 0.01 s"]),
    ("paper", {"controller.gains.lambda_1": [0.2, 0.0, *[1.0] * 4]}, ["controller.gains.lambda_1 is 0 along y"]),
    ("paper", {"phases.land_start": 5}, ["paper: phases.land_start = 5.0 is before the lift ends at 8 s"]),
    ("paper", REAL, ["the pitch loop oscillates with the rotors' lag of 18.8 ms"]),
    ("flight-ready", {"plant.mass_scale": 0.67}, ["along z with 11.3 N", "stays 0.18 m off", "plant.mass_scale"]),
    ("flight-ready", {"disturbance.force": [3.0, 0.0, 0.0]}, ["stays 0.397 m off", "observer.model"]),
    ("flight-ready", {**REAL, "initial.velocity": [-2.9, 0.0, 0.0]}, ["rad of tilt along x"]),
    (
        "flight-ready",
        {**REAL, "initial.rates": [0.0, 0.0, -1.8]},
        ["N m in yaw (its law commands 9.24", "the rotors can exert 1.33 in hover"],
    ),
    ("zigzag", {"corridor.width": 2.6}, ["with its heading kept"]),
    ("narrow", {"corridor.width": 0.7}, ["trailing behind its end"]),
    ("zigzag", {"mission.duration": 30.0}, ["the person's path of"]),
]


@for_all([*[("iris", *row) for row in TOLD.values()], *TOLD_OF_OTHERS])
def test_what_may_fly_badly_is_warned_of(case):
    name, changes, pieces = case
    words = warnings_of(name, changes)
    assert [piece for piece in pieces if piece not in words] == [], words
    assert all(line.startswith(f"{name}: ") for line in words.splitlines())


FINE = [
    ("iris", {"mission.step": 0.002}),
    ("iris", {"ground.height": -0.145}),  # feet just above the floor
    ("iris", {"walls": BESIDE}),
    ("iris", gusts(([1.0, 0.0, 0.0], 1.0, 1.0))),
    ("iris", gusts(([1.0, 0.0, 0.0], 20.0, 0.5, 2.0), ([0.0, 3.0, 0.0], 30.0, 0.5))),
    ("iris", gusts((X4, 80.0, 0.5, 2.0))),
    ("iris", gusts((X2, 20.0, 0.5)) | COMPENSATED),
    ("iris", wind(2.0, 0.0)),
    ("iris", {"plant.mass_scale": 1.25}),
    ("iris", {"faults": WEAK[:1]}),
    ("iris", {"pushes.0.time": 14.0}),
    ("iris", {**NO_TARE, "sensors.joints.force_bias": 0.0}),
    ("iris", {**NO_TARE, "pilot.push": "truth"}),
    ("iris", {"initial.velocity": [1.0, 0.0, 0.0], "initial.rates": [0.0, 0.0, 3.0]}),
    ("iris", {"phases.lift_duration": 1.0, "phases.land_duration": 0.01}),
    ("iris", {"sensors.motion.interval": 0.1}),
    ("iris", {"sensors.interval": 0.02, "sensors.motion.interval": 0.02}),
    (
        "iris",
        {"vehicle.quadrotors.1.position": [0.0, 0.5, 0.2], "vehicle.quadrotors.1.feet_depth": 0.305},
    ),  # a rotor may turn above another one
    ("flight-ready", REAL),
    ("flight-ready", {"plant.mass_scale": 0.9}),
    ("flight-ready", {"plant.mass_scale": 1.15}),
    ("paper", {"initial.velocity": [5.0, 0.0, 0.0], "initial.rates": [0.0, 0.0, 10.0]}),
    ("narrow", {"corridor.width": 1.2}),
    *[("iris", {}, controller) for controller in ("geometric", "lqr", "pid", "smc", "super-twisting")],
]


@for_all(FINE)
def test_what_flies_well_is_not(case):
    assert warnings_of(*case) == ""


@pytest.mark.parametrize("tap", SHORT)
def test_a_tap_that_the_rotors_cannot_counter_is_warned_of_only_if_it_carries_the_vehicle_away(tap):
    flight = tl.fly(load_mission("iris", SHORT[tap]))
    assert warnings_of("iris", SHORT[tap]) == ""
    assert flight.findings == ()
    assert np.linalg.norm(flight["reference_position"] - flight["position"], axis=1).max() < 0.13


TOGETHER = [{"time": time, "sigma": 0.6, "force": [0.2, 0.0, 0.0]} for time in (15.0, 15.2)]
LOWER = [{"time": 13.0, "key": "admittance.threshold", "value": 0.1}]


@for_all(
    [
        push([0.31, 0.2, 0.0]),
        push([0.0, 0.0, 0.0]),
        {"pushes": TOGETHER},
        push([0.2, 0.0, 0.0]) | {"admittance.threshold": 0.19},
        push([0.2, 0.0, 0.0], point=[0.0, 0.9, 0.0]) | {"compliance.yaw.model": "compliant"},  # it turns
        push([0.2, 0.0, 0.0]) | {"changes": LOWER},
    ]
)
def test_a_push_that_moves_the_reference_is_not_called_ignored(changes):
    assert "it is ignored" not in warnings_of("iris", changes)


def test_only_rotors_that_fail_within_the_flight_count_against_what_they_lift():
    assert "its rotors lift" not in warnings_of("iris", all_fail(1e6))


def test_rotors_that_are_all_lost_lift_nothing_to_the_last_digit():
    told = warnings_of("iris", all_fail(5.0))
    assert "its rotors lift 0 N" in told
    assert "of the rotors' 0 N is 0 N: the vehicle cannot fly" in told


def test_a_push_that_is_called_ignored_is_ignored():
    ignored = push([0.29, 0.0, 0.0]) | {"mission.duration": 18.0, "phases.land_start": 60.0}
    flight = tl.fly(load_mission("iris", ignored))
    assert "it is ignored" in warnings_of("iris", ignored)
    moved = flight["reference_position"][flight.time > 13.0]
    assert (moved.max(axis=0) - moved.min(axis=0)).max() < 1e-4  # m: noise beyond the last 0.01 N of the threshold
