"""A simulation stepped by hand is the flight that `tl.fly` flies; what its caller adds does what mechanics says.

The pilot alone gives the thrusts that it gives in a flight, measurement by measurement.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO
from tandemlift.parts.controllers import CONTROLLERS, Command, ControllerTable, control, register
from tandemlift.parts.mechanics.rigid_body import Wrench

FREE = {"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0, "mission.log_interval": 0.001}
CHANGES = [
    {"time": 2.0, "key": "admittance.damping", "value": [4.0, 4.0, 4.0], "duration": 1.0},
    {"time": 4.0, "key": "controller.name", "value": "pid"},
]
FLOWN = {
    "sensors and estimators": ("iris", {"mission.duration": 12.5}),
    "a person and walls": ("zigzag", {"mission.duration": 12.0}),
    "pushes at points": ("off-centre-push", {"mission.duration": 4.0}),
    "changes in flight": ("one-push", {"mission.duration": 6.0, "changes": CHANGES}),
    "a grid that does not divide": ("hover", {"mission.duration": 1.003, "mission.log_interval": 0.007}),
}
RECORDED_ON_THE_WAY = ["a person and walls", "changes in flight", "sensors and estimators"]


def load(name, **changes):
    return tl.load_mission(name, changes)


def stepped(sim, **given):
    """The simulation, stepped to its end."""
    while not sim.over:
        sim.step(**given)
    return sim


def same(a, b):
    """Whether two flights are the same to the last bit; they may have taken other times."""
    a, b = (replace(f, results=f.results | {"wall_s": 0.0}) for f in (a, b))
    return a == b


# without a caller's push


@pytest.mark.parametrize("case", [case for case in FLOWN if case not in RECORDED_ON_THE_WAY])
def test_stepped_to_the_end_it_is_the_flight_to_the_last_bit(case):
    mission = tl.load_mission(*FLOWN[case])
    assert same(stepped(tl.Simulation(mission)).flight(), tl.fly(mission))


def test_it_is_the_flight_in_mujoco_as_well():
    mission = load("hover", **{"mission.duration": 1.0})
    sim = tl.Simulation(mission, engine="mujoco")
    assert same(stepped(sim).flight(), tl.fly(mission, "mujoco"))
    assert same(sim.flight(), tl.fly(mission, "mujoco"))


@pytest.mark.parametrize("case", RECORDED_ON_THE_WAY)
def test_the_record_asked_for_on_the_way_is_that_of_a_shorter_flight_and_changes_nothing(case):
    name, changes = FLOWN[case]
    sim = tl.Simulation(tl.load_mission(name, changes))
    for k in (1, 16, 1000, 4300):
        while sim.k < k:
            sim.step()
        shorter = tl.fly(tl.load_mission(name, changes | {"mission.duration": k * sim.dt}))
        flight = sim.flight()
        assert [n for n in flight if flight[n].tobytes() != shorter[n].tobytes()] == []
        assert flight.metrics() == shorter.metrics() | {"wall_s": flight.metrics()["wall_s"]}
    assert same(stepped(sim).flight(), tl.fly(sim.mission))


class Weightless(NamedTuple):
    """Gains of a controller in plain Python: it holds the weight, and turns nothing."""

    weight: float


class Asked:
    """Its memory, which it changes in place: how often it was asked."""

    times = 0


@pytest.fixture
def plain_python():
    """The name of a controller in plain Python, whose thrust tells how often it was asked."""

    class Settings(ControllerTable):
        name: str = "plain-python"

    @control.register(Weightless, compiled=False)
    def call(gains, memory, measured, reference):
        memory.times += 1
        return Command(Wrench(gains.weight + 1e-3 * memory.times, ZERO), ZERO), memory

    register("plain-python", Settings)(lambda s, vehicle, step: (Weightless(vehicle.mass * GRAVITY), Asked()))
    yield "plain-python"
    CONTROLLERS.pop("plain-python")
    control.table.pop(Weightless)
    control.interpreted.discard(Weightless)


def test_a_controller_in_plain_python_is_asked_once_a_step_and_once_at_the_end(plain_python):
    mission = load("hover", **{"controller": {"name": plain_python}, "mission.duration": 0.2})
    sim, flown = tl.Simulation(mission), tl.fly(mission)
    while not sim.over:
        sim.step()
        assert len(sim.flight().time) == 1 + (sim.k - 1) // 10 + (sim.k == 200)
    assert same(sim.flight(), flown)
    assert np.ptp(np.diff(flown["thrust"])) < 1e-9
    sim.reset()
    assert same(stepped(sim).flight(), flown)


@pytest.mark.parametrize("engine", ["compiled", "mujoco"])
def test_ctrl_c_in_a_step_loses_or_repeats_none(engine, monkeypatch):
    """It comes as soon as machine code returns."""
    sim, flown = (tl.Simulation(load("one-push", **{"mission.duration": 0.3}), engine) for _ in range(2))
    sim.step(steps=100)
    held = sim._stepper.code.held

    def interrupted(address, run=held["fly"]):
        run(address)
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setitem(held, "fly", interrupted)
        with pytest.raises(KeyboardInterrupt):
            sim.step()
    assert sim.k == 101
    assert same(stepped(sim).flight(), stepped(flown).flight())


# what a caller adds


@pytest.mark.parametrize(("engine", "tolerance"), [("compiled", 1e-12), ("mujoco", 1e-9)])
def test_without_thrusts_it_falls_and_a_constant_push_accelerates_it(engine, tolerance):
    mission = load("hover", **FREE, **{"initial.velocity": [0.5, 0.0, 2.0], "initial.position": [0.0, 0.0, 5.0]})
    sim, F = tl.Simulation(mission, engine), np.array([0.7, -1.1, 3.0])
    mass = tl.Vehicle.from_settings(mission.vehicle).mass
    for _ in range(800):
        state = sim.step(push=F, thrusts=np.zeros(8))
    a, t = F / mass - [0.0, 0.0, GRAVITY], sim.time
    v = np.array([0.5, 0.0, 2.0]) + a * t
    np.testing.assert_allclose(state[:3], [0.5 * t, 0.0, 5.0 + 2.0 * t] + a * t * t / 2, atol=tolerance)
    np.testing.assert_allclose(state[3:6], v, atol=tolerance)
    np.testing.assert_allclose(state[6:], [1, 0, 0, 0, 0, 0, 0], atol=tolerance)
    metrics = sim.flight().metrics()
    np.testing.assert_allclose(metrics["human_impulse_n_s"], F * t, rtol=1e-12)
    work = F @ (state[:3] - [0.0, 0.0, 5.0])
    assert metrics["human_work_j"] == pytest.approx(
        work - F @ a * t * sim.dt / 2, rel=1e-9
    )  # the sum over starts of steps


def test_a_push_at_a_point_turns_the_body_as_newton_and_euler_say():
    mission = load("hover", **FREE, **{"initial.euler": [0.2, -0.1, 0.4], "initial.rates": [0.3, 0.1, -0.2]})
    vehicle, F, r = tl.Vehicle.from_settings(mission.vehicle), np.array([0.8, -0.5, 0.6]), np.array([0.1, 0.9, -0.05])
    J, sim = np.array(vehicle.inertia), tl.Simulation(mission)
    start = sim.state

    def motion(t, x):
        R = Rotation.from_quat(x[6:10], scalar_first=True)
        w = x[10:]
        spin = np.array([[0, *-w], [w[0], 0, w[2], -w[1]], [w[1], -w[2], 0, w[0]], [w[2], w[1], -w[0], 0]])
        turning = np.linalg.solve(J, np.cross(r, R.inv().apply(F)) - np.cross(w, J @ w))
        return [*x[3:6], *(F / vehicle.mass - [0, 0, GRAVITY]), *(0.5 * spin @ x[6:10]), *turning]

    for _ in range(600):
        state = sim.step(F, np.zeros(8), point=r)
    solved = solve_ivp(motion, (0.0, sim.time), start, method="DOP853", rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(state, solved.y[:, -1], atol=1e-10)
    moment = np.cross(r, Rotation.from_quat(sim["attitude"], scalar_first=True).inv().apply(F))
    np.testing.assert_allclose(sim["push_moment"], moment, atol=1e-13)


@pytest.mark.parametrize(("name", "point", "duration"), [("hover", [0.0] * 3, 4.0), ("iris", [0.0, 0.4, 0.0], 13.0)])
def test_a_constant_push_moves_pilot_and_body_as_a_very_long_push_of_the_mission_does(name, point, duration):
    keys = {"mission.duration": duration, "mission.log_interval": 0.05}
    F = [0.6, -0.4, 0.2]
    long = tl.fly(load(name, pushes=[{"force": F, "time": 6.0, "sigma": 1e7, "point": point}], **keys))
    flight = stepped(tl.Simulation(load(name, pushes=[], **keys)), push=F, point=point).flight()
    for channel in flight:  # the last sample is of no step
        np.testing.assert_allclose(flight[channel][:-1], long[channel][:-1], atol=1e-9, err_msg=channel)
    assert np.abs(flight["push_moment"]).max() > 0.05 or not any(point)


@pytest.mark.parametrize("engine", ["compiled", "mujoco"])
def test_what_is_given_acts_over_one_step_alone_and_beside_what_the_mission_pushes(engine):
    mission = load("one-push", **{"mission.log_interval": 0.001, "mission.duration": 3.0, "pushes.0.time": 2.0})
    plain, sim = tl.fly(mission, engine), tl.Simulation(mission, engine)
    while sim.k < 2000:
        before = sim.step()
    after = sim.step(push=[2.0, 0.0, 0.0])
    np.testing.assert_array_equal(sim["push_force"], [5.0, 0.0, 0.0])
    np.testing.assert_array_equal(sim["position"], before[:3])
    gained = after[3:6] - plain["velocity"][2001]
    mass = tl.Vehicle.from_settings(mission.vehicle).mass
    np.testing.assert_allclose(gained, [2.0 * sim.dt / mass, 0.0, 0.0], atol=2e-6)
    sim.step()
    np.testing.assert_array_equal(sim["push_force"], plain["push_force"][2001])


def test_the_pilot_takes_over_again():
    sim = tl.Simulation(load("hover", **{"mission.duration": 20.0}))
    while sim.time < 10.0:
        sim.step()
    held = sim["rotor_thrusts"]
    for _ in range(300):
        sim.step(push=[0.0, 0.0, 1.0], thrusts=held * 1.02)
    assert sim.state[2] > 1.01
    assert np.any(sim["thrust"] != pytest.approx(held.sum(), rel=1e-3))  # what the pilot wants meanwhile
    stepped(sim)
    assert np.linalg.norm(sim["position_error"]) < 2e-3


# the object


def test_a_sample_is_of_the_start_of_the_step_taken_last_and_the_state_of_its_end():
    mission = load("iris", **{"mission.duration": 0.5, "mission.log_interval": 0.001})
    flown, sim = tl.fly(mission), tl.Simulation(mission)
    assert sim.time == 0.0
    assert math.isnan(sim.sample_time)
    assert set(sim.channels) == {name for name in flown.channels if not name.endswith("_stamp")}
    for k in range(400):
        state = sim.step()
        assert (sim.k, sim.time, sim.sample_time) == (k + 1, (k + 1) * sim.dt, k * sim.dt)
        names = ("position", "velocity", "attitude", "rates")
        np.testing.assert_array_equal(state, np.concatenate([flown[name][k + 1] for name in names]))
        np.testing.assert_array_equal(sim.state, state)
        for name in (*sim.channels, "position_error"):
            np.testing.assert_array_equal(sim[name], flown[name][k])
            assert sim.info(name) == flown.info(name)
    kept = sim["joint_force"]
    kept[:] = 0.0
    np.testing.assert_array_equal(sim["joint_force"], flown["joint_force"][399])
    assert "wind_force" not in sim
    assert "position" in sim
    assert list(sim) == list(sim.channels)
    assert repr(sim) == "<Simulation iris in compiled: 0.4 s, 400 steps>"


def test_a_reset_begins_the_same_again_or_another_with_another_seed():
    sim = tl.Simulation(load("iris", **{"mission.duration": 1.0}))
    first = stepped(sim).flight()
    np.testing.assert_array_equal(sim.reset()[:3], first["position"][0])
    assert (sim.k, sim.time, sim.over) == (0, 0.0, False)
    assert same(stepped(sim).flight(), first)
    sim.reset(seed=np.int64(7))
    assert same(stepped(sim).flight(), tl.fly(load("iris", **{"mission.duration": 1.0, "mission.seed": 7})))
    sim.reset()
    assert sim.mission.mission.seed == 7


def test_a_flight_that_turns_over_is_over_and_its_record_says_why():
    sim = tl.Simulation(load("hover"))
    while not sim.over:
        sim.step(thrusts=[3.0] * 4 + [8.0] * 4)
    assert sim.lost
    assert sim.ending is not None
    assert sim.ending.quantity == "tilt [deg]"
    flight = sim.flight()
    assert flight.ending == sim.ending
    assert flight.metrics()["steps"] == sim.k
    with pytest.raises(tl.InputError, match=r"crashed at .* s: tilt .*; reset\(\) begins anew"):
        sim.step()
    sim.reset()
    assert not sim.lost
    assert sim.ending is None
    sim.step()


def test_past_the_end_of_its_mission_it_takes_no_step():
    sim = stepped(tl.Simulation(load("hover", **{"mission.duration": 0.01})))
    assert (sim.k, sim.lost, sim.ending) == (10, False, None)
    with pytest.raises(tl.InputError, match=r"mission.duration = 0.01 s; reset\(\) begins anew"):
        sim.step()


BAD: list[tuple[dict[str, Any], str]] = [
    ({"push": [1.0, 2.0]}, r"push = \[1.0, 2.0\]: must be 3 finite numbers \(N, in world axes\)"),
    ({"push": 1.0}, r"push = 1.0: must be 3 finite"),
    ({"push": np.array([1.0, math.nan, 0.0])}, r"push = .*nan.*: must be 3 finite"),
    ({"push": ["a", "b", "c"]}, r"push = .*: must be 3 finite"),
    ({"push": [[1.0], [2.0, 3.0], [4.0]]}, r"push = .*: must be 3 finite"),
    ({"push": [1.0j, 0.0, 0.0]}, r"push = .*: must be 3 finite"),
    (
        {"push": [1.0, 0.0, 0.0], "point": [0.0, 1.0]},
        r"point = \[0.0, 1.0\]: must be 3 finite numbers \(m, in body axes\)",
    ),
    ({"point": [0.0, 1.0, 0.0]}, r"point = \[0.0, 1.0, 0.0\]: must come with a push"),
    ({"thrusts": np.zeros(4)}, r"thrusts = .*: must be 8 finite numbers \(N, one for each rotor\)"),
    ({"thrusts": [0.0] * 7 + [-math.inf]}, r"thrusts = .*: must be 8 finite"),
]


def test_what_cannot_be_added_to_a_step_is_refused_by_its_name_and_nothing_moves():
    sim = tl.Simulation(load("hover"))
    for given, words in BAD:
        with pytest.raises(tl.InputError, match=words):
            sim.step(**given)
        assert sim.k == 0
    sim.step()
    np.testing.assert_array_equal(sim["push_force"], [0.0, 0.0, 0.0])


def test_what_cannot_be_asked_for_is_refused():
    sim = tl.Simulation(load("hover"))
    for seed in (-1, 1.5, "7", 10**19):
        with pytest.raises(tl.InputError, match=r"seed = .*: must be a whole number from 0 to 1e\+18"):
            sim.reset(seed=seed)
    with pytest.raises(tl.InputError, match="'position': no step has been taken yet"):
        sim["position"]
    with pytest.raises(KeyError, match="Did you mean 'position'"):
        sim["positon"]
    with pytest.raises(KeyError, match="no channel 'wind'"):
        sim.info("wind")
    with pytest.raises(tl.InputError, match="nothing is logged yet"):
        tl.Simulation(load("hover"), engine="mujoco").flight()


# the pilot alone


def measurements(flight):
    """What the pilot read at every step of a flight that was logged at every step (T, 16)."""
    names = ("position", "velocity", "attitude", "rates", "push_force")
    return np.ascontiguousarray(np.hstack([flight[name] for name in names]))


def test_it_gives_the_thrusts_of_the_flight_to_the_last_bit_and_again_after_a_reset():
    mission = tl.load_mission("flight-ready", {"mission.duration": 14.0, "mission.log_interval": 0.001})
    flight, pilot = tl.fly(mission), tl.Pilot(mission)
    assert np.abs(flight["push_force"]).max() > 1.0
    for _ in range(2):
        thrusts = np.array([pilot.step(x).copy() for x in measurements(flight)])
        assert np.array_equal(thrusts, flight["rotor_thrusts"])
        pilot.reset()


def test_what_is_no_measurement_is_refused():
    pilot = tl.Pilot(tl.load_mission("hover"))
    for measurement in (np.zeros(15), np.zeros((1, 16)), np.zeros(16, dtype=np.float32), [0.0] * 16, None):
        with pytest.raises(tl.InputError, match=r"must be a float64 array of shape \(16,\)"):
            pilot.step(measurement)
    for moment in (5.0, np.zeros(4), [[1.0], [2.0], [3.0]], "up"):
        with pytest.raises(tl.InputError, match=r"moment = .+: must be 3 numbers \[N m\]"):
            pilot.step(np.eye(16)[6], moment)


def test_without_supervision_a_number_that_is_not_finite_is_refused_and_nothing_remembered():
    good, memory = np.eye(16)[6], []
    for given in ({}, {"supervision.model": "on"}):
        pilot = tl.Pilot(load("iris", **given))
        pilot.step(good)
        memory.append(pilot.memory)
    plain = tl.Pilot(load("iris"))
    for at, value in ((0, np.nan), (9, np.inf), (15, -np.inf)):
        bad = good.copy()
        bad[at] = value
        with pytest.raises(tl.InputError, match=rf"measurement\[{at}\] = {value}: must be a finite number"):
            plain.step(bad)
        pilot.step(bad)
    with pytest.raises(tl.InputError, match=r"moment\[2\] = nan"):
        plain.step(good, np.array([0.0, 0.0, np.nan]))
    plain.step(good)
    np.testing.assert_array_equal(plain.memory, memory[0])
    assert np.isfinite(pilot.memory).all()


@pytest.mark.thorough
def test_by_hand_it_stops_its_rotors_for_good_when_asked():
    pilot, level = tl.Pilot(tl.load_mission("hover", {"pilot.guidance": "interactive"})), np.zeros(16)
    level[6] = 1.0
    assert pilot.step(level).sum() > 0.0
    assert not pilot.step(level, stop=True).any()
    assert not pilot.step(level, lift=True).any()
    pilot.reset()
    assert pilot.step(level, enabled=False).sum() > 0.0
