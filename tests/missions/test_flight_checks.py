"""What cannot fly well is warned of before it flies, by numbers; what flies well is not."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.errors import CLOSE, FAILS, OK, REFUSED, judged
from tandemlift.core.vector import ZERO, vec3
from tandemlift.missions import load_mission
from tandemlift.missions.checks import mission_checks
from tandemlift.missions.flight_checks import CHECKS, flight_checks
from tandemlift.missions.outcomes import promise_of
from tandemlift.parts.flight_checks.authority import CONTROL
from tandemlift.parts.flight_checks.hover_loads import SIGMAS, WindOnParts, loads_of
from tandemlift.parts.flight_checks.schedule_checks import Schedule
from tandemlift.parts.flight_checks.sensing_checks import noise_of, push_bandwidths
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.wind import air_loads
from tandemlift.parts.person.passage import least_room, places_of
from tandemlift.simulation.preparation.assemble import assemble


def wind(x, y):
    return {"wind.model": "air", "wind.velocity": [x, y, 0.0], "wind.turbulence": 7.7}


def test_every_result_is_of_a_check_in_the_table():
    names = {check.name for check in CHECKS}
    for name in ("paper", "iris", "zigzag", "rotor-loss"):
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
    assert room == pytest.approx(2.0 - 1.0, abs=0.01)  # half of 4 m less the arm of 1 m, where it runs along x


def test_the_share_left_for_control_is_where_flights_begin_to_saturate():
    """With 80 % of the authority as a yaw moment iris holds its heading, with 110 % it does not."""
    yaw = float(load_mission("iris").hover.authority[2])
    turned = []
    for share in (1.0 - CONTROL - 0.05, 1.1):
        quick = {"disturbance.moment": [0.0, 0.0, share * yaw], "pushes": [], "mission.duration": 30.0}
        turned.append(float(np.abs(tl.fly(load_mission("iris", {**quick, "phases.land_start": 60.0}))["euler"][-1, 2])))
    assert turned[0] < 0.05 < turned[1]


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


def test_the_offset_that_is_told_is_the_one_that_is_flown():
    mission = load_mission("flight-ready", {"plant.mass_scale": 0.8, "pushes": [], "mission.duration": 40.0})
    (predicted,) = [r.value for r in flight_checks(mission) if r.check == "offset" and r.subject == "z"]
    assert tl.fly(mission).metrics()["position_max_error_after_10s_m"][2] == pytest.approx(predicted, rel=0.03)


@pytest.mark.parametrize(("name", "force"), [("iris", 3.0), ("crazyflie-stick", 3.0 * 0.09936 / 3.5)])
def test_the_hand_that_pushes_suits_the_weight(name, force):
    checks = [check for check in flight_checks(load_mission(name)) if check.check == "push"]
    assert [check.value for check in checks] == pytest.approx([force] * 3, rel=1e-12)
    assert f"a push of {force:.3g} N level" in "".join(check.text for check in checks)


def test_a_caller_pushes_the_vehicle_and_not_the_air():
    simulation = tl.Simulation(load_mission("paper"))
    simulation.step(push=[1.0, 0.0, 0.0], point=[0.0, 1.2, 0.0])
    with pytest.raises(tl.InputError, match=r"point = \[0.0, 50.0, 0.0\]: must be on the vehicle"):
        simulation.step(push=[1.0, 0.0, 0.0], point=[0.0, 50.0, 0.0])


def test_a_recorded_hand_that_holds_the_air_is_refused(tmp_path):
    hand = np.zeros((1, 14))
    hand[0, 1:4] = 3.0
    path = tmp_path / "hand.npz"
    np.savez(path, step=np.array([100]), hand=hand)
    with pytest.raises(tl.InputError, match=r"a grip in .*hand.npz = \[3.0, 3.0, 3.0\]: must be on the vehicle"):
        load_mission("iris", {"person.model": "virtual-hand", "person.recording": str(path)})


# loading and `check` read one list of checks


def test_a_refused_mission_has_the_refusal_that_loading_says_and_nothing_after_it():
    iris = load_mission("iris")
    broken = iris.model_copy(update={"allocation": iris.allocation.model_copy(update={"method": "pseudo-inverse"})})
    (result,) = mission_checks(broken)
    assert result.verdict == REFUSED
    assert tl.check(broken) == (result,)
    with pytest.raises(tl.InputError) as refusal:
        load_mission("iris", {"allocation.method": "pseudo-inverse"})
    assert str(refusal.value) == f"iris: {result.text}"


def test_loading_warns_of_what_fails():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        mission = load_mission("iris", {"plant.mass_scale": 0.5, "sensors.joints.force_range": 2.0})
    failed = [result.text for result in mission_checks(mission) if result.verdict == FAILS]
    assert len(told) >= 3
    assert {str(one.message).removeprefix("iris: ") for one in told} <= set(failed)


@pytest.mark.parametrize("name", ["paper", "one-push", "hover"])
def test_guidance_by_hand_has_a_soft_gate(name):
    by_hand = {"pilot.guidance": "interactive"}
    for gate in ({}, {"admittance.gate": "soft"}):
        assert load_mission(name, by_hand | gate).admittance.gate in (None, "soft")
    with pytest.raises(tl.InputError, match=r'admittance\.gate = "hard": must be "soft" or left out'):
        load_mission(name, by_hand | {"admittance.gate": "hard"})
    assert load_mission(name, {"admittance.gate": "hard"}).admittance.gate == "hard"


def test_a_promised_distance_brings_its_root_mean_square_along():
    mission = load_mission("iris", {"promise.distance": 0.04})
    assert promise_of(mission.promise, "interactive").rms_promised("interactive") == 0.04
