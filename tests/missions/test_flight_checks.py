"""What cannot fly well is warned of before it flies, by numbers; what flies well is not."""

from __future__ import annotations

import numpy as np
import pytest
from warned import warnings_of

import tandemlift as tl
from tandemlift.core.errors import CLOSE, FAILS, OK, judged
from tandemlift.core.vector import ZERO, vec3
from tandemlift.missions import built_in, load_mission, tables_of
from tandemlift.missions.flight_checks import CHECKS, flight_checks
from tandemlift.parts.interaction.passage import least_room, places_of
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.wind import air_loads
from tandemlift.parts.pilot.schedule_checks import Schedule
from tandemlift.parts.pilot.sensing_checks import noise_of, push_bandwidths
from tandemlift.parts.rotors.authority import CONTROL
from tandemlift.parts.rotors.hover_loads import SIGMAS, WindOnParts, loads_of
from tandemlift.simulation.preparation.assemble import assemble

IRIS = tables_of(load_mission("iris"))["vehicle"]["quadrotors"]


def rotors(**factors):
    """The rotors of iris, with numbers of them multiplied."""
    return {"vehicle.quadrotors": [{**q, **{name: q[name] * f for name, f in factors.items()}} for q in IRIS]}


def wind(x, y):
    return {"wind.model": "air", "wind.velocity": [x, y, 0.0], "wind.turbulence": 7.7}


def push(**keys):
    return {"pushes": [{"time": 15.0, "sigma": 0.6, **keys}]}


HEARD = "turbulence pushes the payload along x"
TOLD = {  # of iris, and what its warnings must say: quantity, limit, key
    "delay 0.1 s": ({"actuators.delay": 0.1}, ["the z loop tolerates 5", "actuators.delay = 0.1 s", "102 ms"]),
    "delay 0.2 s": ({"actuators.delay": 0.2}, ["the z loop tolerates 5", "actuators.delay = 0.2 s", "202 ms"]),
    "lag 0.5 s": (rotors(lag_up=40.0, lag_down=20.0), ["oscillates with the rotors' lag of 500 ms", "lag_up"]),
    "slow and late": (rotors(lag_up=4.0, lag_down=4.0) | {"actuators.delay": 0.03}, ["tolerates 2", "31.5 ms"]),
    "an unknown yaw moment": ({"disturbance.moment": [0.0, 0.0, 3.0]}, ["yaw moment of 3 N m", "disturbance.moment"]),
    "wind along x": (wind(4.0, 0.0), [HEARD, "admittance.threshold is 0.3 N", "controller.max_tilt = 0.25"]),
    "wind along -x": (wind(-4.0, 0.0), [HEARD]),
    "wind along y": (wind(0.0, 4.0), [HEARD]),
    "wind along -y": (wind(0.0, -4.0), [HEARD, "estimator.wind_compensation"]),
    "weak rotors": (rotors(thrust_constant=0.65), ["34.3 N", "compliance.thrust_fraction = 0.9", "33.1 N"]),
    "30 N downwards": ({"disturbance.force": [0.0, 0.0, -30.0]}, ["64.3 N", "56.5 N", "cannot fly"]),
    "a push of 30 N downwards": (push(force=[0.0, 0.0, -30.0]), ["in pushes.0, hover needs 64.3 N", "on the floor"]),
    "a push into the floor": (
        push(force=[0.0, 0.0, -5.0]),
        ["pushes.0 moves the reference down", "phases.height = 1 m"],
    ),
    "a push that turns over": (push(force=[10.0, 0.0, 0.0], point=[0.0, 0.0, 0.5]), ["pitch moment of 5 N m"]),
    "a push that carries away": (push(force=[15.0, 0.0, 0.0]), ["15 N across", "controller.max_tilt"]),
    "a push in the lift": (push(force=[3.0, 0.0, 0.0], time=5.0), ["pushes.0 has its peak at 5 s", "12 s"]),
    "a landing too late": ({"phases.land_start": 85.0}, ["takes until 97 s", "mission.duration is 90 s"]),
    "a push below the threshold": (
        push(force=[0.2, 0.0, 0.1]),
        ["pushes.0 has 0.2 N along x", "admittance.threshold is 0.3 N", "it is ignored"],
    ),
    "noise above the threshold": ({"sensors.joints.force_noise": 1.0}, ["noise is followed as a push"]),
    "a supervision that refuses": (
        {"supervision.model": "on", "supervision.checks.thrust_fraction": 0.6},
        ["supervision.checks.thrust_fraction = 0.6", "the lift is refused"],
    ),
}


@pytest.mark.parametrize(("changes", "pieces"), TOLD.values(), ids=TOLD)
def test_what_ends_badly_is_warned_of(changes, pieces):
    words = warnings_of("iris", changes)
    assert [piece for piece in pieces if piece not in words] == [], words


def test_gains_of_the_paper_on_real_rotors_are_warned_of():
    assert "the pitch loop oscillates with the rotors' lag of 18.8 ms" in warnings_of(
        "paper", {"actuators.model": "rotors"}
    )


def test_a_start_that_asks_for_more_than_the_rotors_have_is_warned_of():
    real = {"actuators.model": "rotors"}
    assert warnings_of("flight-ready", real) == ""
    assert "rad of tilt along x" in warnings_of("flight-ready", {**real, "initial.velocity": [-2.9, 0.0, 0.0]})
    assert "N m in yaw; the rotors give" in warnings_of("flight-ready", {**real, "initial.rates": [0.0, 0.0, -1.8]})


@pytest.mark.parametrize(
    "changes",
    [
        push(force=[0.31, 0.2, 0.0]),
        push(force=[0.0, 0.0, 0.0]),
        {"pushes": [{"time": time, "sigma": 0.6, "force": [0.2, 0.0, 0.0]} for time in (15.0, 15.2)]},
        push(force=[0.2, 0.0, 0.0]) | {"admittance.threshold": 0.19},
        push(force=[0.2, 0.0, 0.0], point=[0.0, 0.9, 0.0]) | {"compliance.yaw.model": "compliant"},
        push(force=[0.2, 0.0, 0.0]) | {"changes": [{"time": 13.0, "key": "admittance.threshold", "value": 0.1}]},
    ],
    ids=["above", "none", "two together", "a low threshold", "turns", "a threshold that changes"],
)
def test_a_push_that_moves_the_reference_is_not_called_ignored(changes):
    assert "it is ignored" not in warnings_of("iris", changes)


def test_a_push_that_is_called_ignored_is_ignored():
    ignored = push(force=[0.29, 0.0, 0.0]) | {"mission.duration": 18.0, "phases.land_start": 60.0}
    flight = tl.fly(load_mission("iris", ignored))
    assert "it is ignored" in warnings_of("iris", ignored)
    moved = np.ptp(flight["reference_position"][flight.time > 13.0], axis=0)
    assert moved.max() < 1e-4  # m: of noise that exceeds the last 0.01 N of the threshold


def test_a_corridor_is_held_against_the_way_the_vehicle_is_led():
    assert "with its heading kept" in warnings_of("zigzag", {"corridor.width": 2.6})
    assert "trailing behind its end" in warnings_of("narrow", {"corridor.width": 0.7})
    assert warnings_of("narrow", {"corridor.width": 1.2}) == ""


def test_a_way_that_is_too_long_for_its_mission_is_warned_of():
    assert "the person's path of" in warnings_of("zigzag", {"mission.duration": 30.0})


@pytest.mark.parametrize("controller", ["geometric", "lqr", "pid", "smc", "super-twisting"])
def test_no_tuned_controller_is_warned_of(controller):
    assert warnings_of("iris", {}, controller) == ""


def test_a_lift_down_into_a_floor_is_refused():
    with pytest.raises(tl.InputError, match=r"phases.height = -1.0: must be 0 or above over a floor"):
        load_mission("iris", {"phases.height": -1.0})
    assert load_mission("paper", {"phases.height": -1.0}).phases.height == -1.0  # without a floor it flies


def test_every_result_is_of_a_check_in_the_table():
    names = {check.name for check in CHECKS}
    for name in built_in():
        assert {result.check for result in flight_checks(load_mission(name))} <= names


@pytest.mark.parametrize(("value", "verdict"), [(0.5, OK), (0.95, CLOSE), (1.0, CLOSE), (1.01, FAILS), (np.inf, FAILS)])
def test_a_verdict_follows_from_the_margin(value, verdict):
    result = judged("thrust", value, 1.0, "N", "says why")
    assert (result.verdict, bool(result.text)) == (verdict, verdict == FAILS)
    assert result.margin == pytest.approx(1.0 - value)


def test_the_authority_is_where_the_first_rotor_meets_a_limit_and_no_more_than_what_any_thrusts_can_give():
    linprog = pytest.importorskip("scipy.optimize").linprog
    mission = load_mission("iris")
    vehicle, authority = mission.hover.vehicle, mission.hover.authority
    most = mission.vehicle.quadrotors[0].thrust_limit
    for i in range(3):
        wrench = np.array([mission.hover.weight, 0.0, 0.0, 0.0])
        ends = [
            vehicle.allocation(mission.allocation.weights) @ (wrench + sign * authority[i] * np.eye(4)[1 + i])
            for sign in (1, -1)
        ]
        assert min(min(f.min(), most - f.max()) for f in ends) == pytest.approx(0.0, abs=1e-9)
        rows = vehicle.effect[[0, *[1 + j for j in range(3) if j != i]]]
        best = linprog(-vehicle.effect[1 + i], A_eq=rows, b_eq=[wrench[0], 0.0, 0.0], bounds=(0.0, most))
        assert 0.9 * -best.fun < authority[i] <= -best.fun * (1.0 + 1e-9)


def test_the_wind_on_the_parts_is_that_of_the_flight():
    mission = load_mission("iris", {**wind(3.0, -2.0), "initial.euler": [0.0, 0.0, 0.0]})
    model = assemble(mission).model
    state = State(ZERO, ZERO, quaternion_from_euler(ZERO), ZERO)

    def flown(air):
        loads = air_loads(model.wind.drag, model.plant.frame, state, vec3(air))
        return np.array([*loads.payload.force]) + np.array([sum(part) for part in loads.quadrotors.force])

    air, wound = (
        np.array(mission.wind.velocity),
        WindOnParts(mission.wind, mission.hover.vehicle, 0.0, mission.mission.step),
    )
    force, _, spread, _ = wound.at(None)
    assert force == pytest.approx(flown(air), rel=1e-12)
    slopes = [(flown(air + 1e-6 * eddy) - flown(air - 1e-6 * eddy)) / 2e-6 for eddy in wound.eddies]
    assert spread == pytest.approx(np.sqrt(np.sum(np.square(slopes), axis=0)), rel=1e-6)
    load = next(loads_of(mission.disturbance, wound, mission.pushes, 90.0, yielding_yaw=True))
    assert load.across == pytest.approx(np.hypot(*force[:2]) + SIGMAS * np.hypot(*spread[:2]))


def schedule_of(mission):
    return Schedule(mission.phases, mission.pushes, mission.admittance, mission.by_hand, mission.mission.duration)


def test_pushes_move_the_reference_as_they_do_in_flight():
    mission = load_mission("off-centre-push")
    ((number, height),) = [(i, h) for i, h in schedule_of(mission).heights if mission.pushes[i].force[2]]
    flight = tl.fly(mission)
    reference = flight["reference_position"][:, 2] - flight["reference_position"][0, 2]
    before_landing = np.searchsorted(flight.time, mission.phases.land_start) - 1
    assert number == 3
    assert height == pytest.approx(reference[before_landing], abs=0.05)


def test_a_landing_takes_as_long_as_in_flight():
    high = {"pushes": [], "phases.height": 3.0, "phases.land_start": 20.0, "phases.land_duration": 5.0}
    mission = load_mission("iris", high)
    flight = tl.fly(mission)
    idle = flight.time[(flight["phase"] == 0.0) & (flight.time > 20.5)]
    assert idle[0] - 20.0 == pytest.approx(schedule_of(mission).landing_duration, rel=0.1)


def test_the_noise_of_the_push_is_that_of_the_flight():
    mission = load_mission(
        "iris", {"pushes": [], "mission.duration": 30.0, "mission.log_interval": 0.001, "phases.land_start": 60.0}
    )
    flight = tl.fly(mission)
    hovers = flight.time > 14.0
    filtered = flight["push_filtered"][hovers]
    bandwidths = push_bandwidths(mission.pilot, mission.estimator, mission.compliance)
    noise = noise_of(mission.sensors, mission.hover.vehicle, bandwidths, mission.mission.step)
    assert noise == pytest.approx(filtered[:, 2].std(), rel=0.35)


def test_a_trailing_vehicle_ends_behind_its_grip_and_a_kept_heading_is_kept():
    narrow, zigzag = load_mission("narrow"), load_mission("zigzag")
    trail, kept = (places_of(m.person, m.corridor, m.initial, m.hover.vehicle) for m in (narrow, zigzag))
    assert trail.headings[-1] == pytest.approx(-np.pi / 2.0, abs=0.05)
    assert np.ptp(kept.headings) == 0.0
    room, _ = least_room(kept, zigzag.all_walls, zigzag.hover.vehicle)
    assert room == pytest.approx(
        2.0 - 1.0, abs=0.01
    )  # half of 4 m less the quadrotor's arm of 1 m, where it runs along x


def test_the_share_left_for_control_is_where_flights_begin_to_saturate():
    """With 80 % of the authority as a yaw moment iris holds its heading, with 110 % it does not."""
    yaw = float(load_mission("iris").hover.authority[2])
    turned = []
    for share in (1.0 - CONTROL - 0.05, 1.1):
        quick = {"disturbance.moment": [0.0, 0.0, share * yaw], "pushes": [], "mission.duration": 30.0}
        turned.append(float(np.abs(tl.fly(load_mission("iris", {**quick, "phases.land_start": 60.0}))["euler"][-1, 2])))
    assert turned[0] < 0.05 < turned[1]


def test_the_lag_is_the_mean_up_and_down():
    assert load_mission("iris").hover.lag == pytest.approx(0.5 * (0.0125 + 0.025))


@pytest.mark.parametrize(("place", "way"), [((0, 1, 0), (1, 0, 0)), ((0, -1, 0), (0, 0, 1)), ((0, 0, 0), (0, 0, -1))])
def test_a_push_of_that_size_brings_the_first_rotor_to_its_limit(place, way):
    mission = load_mission("iris")
    hover, vehicle = mission.hover, mission.hover.vehicle
    place, way = np.array(place, float), np.array(way, float)
    limit = hover.largest_push(place, way)
    balance = np.array([hover.weight - limit * way[2], *-np.cross(place, limit * way)])
    thrusts = vehicle.allocation(mission.allocation.weights) @ balance
    assert vehicle.effect @ thrusts == pytest.approx(balance, abs=1e-9)
    most = vehicle.quadrotors[0].thrust_limit
    assert min(np.abs(thrusts).min(), np.abs(thrusts - most).min()) < 1e-9
    assert thrusts.min() > -1e-9
    assert thrusts.max() < most + 1e-9
