"""The step of MuJoCo in machine code: its numbers are those of a step that calls `mujoco.mj_step` in Python."""

import platform
import sys
import weakref
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
import pytest
from flights import different
from modelled import fleet
from ten_crashes import CRASHES, crash_mission

import tandemlift as tl
from tandemlift.engines.registry import ENGINES, Engine
from tandemlift.engines.touches import ContactLog

mujoco = pytest.importorskip("mujoco")
body_file = pytest.importorskip("tandemlift.engines.mujoco")

WIND = {
    "wind.model": "air",
    "wind.velocity": [3.0, -1.5, 0.4],
    "wind.turbulence": 3.0,
    "wind.gusts": [{"velocity": [0.5, 0.0, 0.0], "start": 2.0, "rise": 1.0, "hold": 5.0}],
}
FALLS = {"faults": [{"quadrotor": 1, "rotor": j, "time": 3.5} for j in (1, 2, 3, 4)]}
PUSHED = {"pushes": [{"force": [1.0, 0.5, -0.3], "time": 1.0, "sigma": 0.3}]}
NEAR_WALL = {
    "ground.model": "floor",
    "ground.height": -1.0,
    "walls": [{"start": [0.9, -9.0], "end": [0.9, 9.0]}],
    "initial.velocity": [1.0, 0.2, 0.0],
}
IRIS = tl.load_mission("iris").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"][0]
RING = [[1.2 * np.cos(a), 1.2 * np.sin(a), IRIS["position"][2]] for a in np.arange(6) * np.pi / 3.0]
SIX = {"vehicle.quadrotors": [{**IRIS, "position": list(map(float, place))} for place in RING]}
ONE = {**fleet(1), "vehicle.quadrotors.0.position": [0.0, 0.0, 0.2]}
REAL = {"plant.mass_scale": 0.9, "disturbance.moment": [0.02, -0.01, 0.005]}
MISSIONS = {
    "iris, off the floor": ("iris", {"mission.duration": 5.0}),
    "iris, a rotor lost": ("iris", {"mission.duration": 6.0, "faults": [{"quadrotor": 1, "rotor": 2, "time": 4.0}]}),
    "iris, fallen": ("iris", {"mission.duration": 6.0, **FALLS}),
    "paper": ("paper", {"mission.duration": 4.0, **PUSHED}),
    "hover, against a wall": ("hover", {"mission.duration": 3.0, **NEAR_WALL}),
    "zigzag": ("zigzag", {"mission.duration": 4.0}),
    "crazyflie-stick": ("crazyflie-stick", {"mission.duration": 5.0}),
    "four": ("four", {"mission.duration": 3.0, **PUSHED}),
    "as it really is": ("hover", {"mission.duration": 2.0, **REAL}),
    "six, fallen": ("iris", {"mission.duration": 6.0, **SIX, **FALLS}),
    "coarse": ("iris", {"mission.duration": 6.0, "mission.step": 0.002, "mission.log_interval": 0.02}),
}
WINDY = {f"{name}, wind": (name, {"mission.duration": 4.0, **WIND}) for name in ("iris", "four", "crazyflie-stick")}
WINDY |= {"one, wind": ("paper", {"mission.duration": 1.0, **ONE, **WIND})}
WINDY |= {"six, wind": ("iris", {"mission.duration": 4.0, **SIX, **WIND})}


def fused(a, b, c):
    """a b + c, rounded once."""
    return float(Fraction(float(a)) * Fraction(float(b)) + Fraction(float(c)))


def product(matrix, vector, first=0):
    """A matrix (3 × 3) times a vector, summed from one number on, as NumPy does on processors with AVX."""
    one, two, three = [first, *[i for i in range(3) if i != first]]
    found = [fused(row[two], vector[two], row[one] * vector[one]) for row in matrix]
    return np.array([fused(row[three], vector[three], x) for row, x in zip(matrix, found, strict=True)])


class StepInPython(body_file.MuJoCoBody):
    """A body that steps with `mujoco.mj_step`, from what MuJoCo's documentation says of its arrays."""

    def __init__(self, scene, vehicle, *surroundings):
        super().__init__(scene, vehicle, *surroundings)
        self.vehicle, self.disturbance = vehicle, scene.disturbance
        self.log = ContactLog(*surroundings, vehicle.count, scene.mission.step)
        self.parts = body_file.touching_parts(self.model)

    def advance(self, thrusts, loads, force, moment):
        data, N = self.data, self.vehicle.count
        if not np.sum(thrusts * thrusts) < 1e16:
            self.state[:] = self.readings[:] = np.nan
            return
        data.ctrl[:] = thrusts
        data.qfrc_applied[:3], data.qfrc_applied[3:] = force + self.disturbance.force, moment + self.disturbance.moment
        if len(loads):
            R = np.empty(9)
            mujoco.mju_quat2Mat(R, data.qpos[3:])
            R = R.reshape(3, 3)
            data.qfrc_applied += loads[:6]
            data.qfrc_applied[3:] += product(body_file.skew(self.vehicle.origin), product(R.T, loads[:3]), 1)
            for i, own in enumerate(loads[6:].reshape(6, N).T, 2):
                data.xfrc_applied[i] = [*own[:3], *product(R, own[3:], int(N == 1))]
        mujoco.mj_step(self.model, data)
        self.state[:] = [*data.qpos[:3], *data.qvel[:3], *data.qpos[3:], *data.qvel[3:]]
        self.readings[:3] = data.sensordata[:3]
        made = np.zeros((2, N, 3))
        for i, (q, t) in enumerate(zip(self.vehicle.quadrotors, thrusts.reshape(N, 4), strict=True)):
            x, y = (np.array(q.rotors) - np.subtract(q.joint_position, q.position)[:2]).T
            of_each = [y * t, -x * t, q.torque_per_thrust * np.array(q.spins) * t]
            made[0, i, 2] = (t[0] + t[2]) + (t[1] + t[3])
            made[1, i] = [(a + c) + (b + d) for a, b, c, d in of_each]
        felt = made - data.sensordata[3 : 6 * N + 3].reshape(2, N, 3)
        self.readings[3 : 6 * N + 3] = felt.transpose(0, 2, 1).ravel()
        if self.model.npair:
            self.readings[6 * N + 3 :] = data.sensordata[6 * N + 3 :]
        load = np.zeros(6)
        for c, pair in enumerate(data.contact.geom.tolist()):
            if tuple(sorted(pair)) in self.parts:
                mujoco.mj_contactForce(self.model, data, c, load)
                self.log.add(*self.parts[tuple(sorted(pair))], load[0], data.contact.pos[c])
        self.log.end_step()
        self.touches[:] = self.log.numbers


@pytest.fixture
def in_python(monkeypatch):
    monkeypatch.setitem(ENGINES, "in python", Engine("in python", "for this test", lambda: StepInPython))
    return lambda mission: tl.fly(mission, "in python")


def mission_named(name):
    base, changes = (MISSIONS | WINDY)[name]
    step = changes.get("mission.step", 0.001)
    return tl.load_mission(base, {"mission.log_interval": step, **changes})


@pytest.mark.thorough
@pytest.mark.parametrize("name", MISSIONS)
def test_a_flight_has_the_bits_of_one_stepped_in_python(name, in_python):
    mission = mission_named(name)
    assert different(tl.fly(mission, "mujoco"), in_python(mission)) == []


@pytest.mark.thorough
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="MuJoCo rounds rotations otherwise there")
@pytest.mark.parametrize("name", WINDY)
def test_a_flight_in_wind_has_the_bits_of_one_stepped_in_python(name, in_python):
    mission = mission_named(name)
    flight = tl.fly(mission, "mujoco")
    assert different(flight, in_python(mission)) == []
    assert np.ptp(flight["wind_velocity"], axis=0).min() > 0.1  # m/s


def test_six_quadrotors_in_wind_fly_as_in_the_compiled_engine():
    """Their sets are loops in machine code, also where the moments of the air on all of them are one number, 0."""
    mission = tl.load_mission("paper", {"mission.duration": 2.0, **SIX, **WIND})
    ours, theirs = tl.fly(mission), tl.fly(mission, "mujoco")
    assert np.abs(ours["position"] - ours["reference_position"]).max() > 0.01  # m
    np.testing.assert_allclose(theirs["position"], ours["position"], atol=1e-6)


@pytest.mark.thorough
@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_has_the_bits_of_one_stepped_in_python(name, in_python):
    mission = crash_mission(name)
    flight = tl.fly(mission, "mujoco")
    assert different(flight, in_python(mission)) == []
    assert flight.outcome == "crashed"


def calls_of_python(run):
    """The calls of Python and of C by Python in `run`, by name, in this thread."""
    calls = Counter()

    def seen(frame, event, what):
        calls[what.__name__ if event == "c_call" else frame.f_code.co_qualname] += event in ("call", "c_call")

    sys.setprofile(seen)
    try:
        run()
    finally:
        sys.setprofile(None)
    return calls


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["iris", "zigzag", "four"])
def test_no_python_runs_in_a_step(name, in_python, monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_OPTIMISE", "0")
    short, long = (tl.load_mission(name, {"mission.duration": d, **WIND}) for d in (1.0, 4.0))
    for mission in (short, long):
        tl.fly(mission, "mujoco")
    few, many = (calls_of_python(lambda m=m: tl.fly(m, "mujoco")) for m in (short, long))
    assert few["mj_step"] == many["mj_step"] == 0
    assert many.total() - few.total() < 100  # of 3000 steps more
    assert calls_of_python(lambda: in_python(short))["mj_step"] == 1001  # so the count would see one


@pytest.mark.thorough
def test_flights_in_threads_at_once_have_the_bits_of_each_alone():
    missions = [mission_named(name) for name in ("iris, fallen", "zigzag", "iris, fallen", "paper")]
    with ThreadPoolExecutor(4) as pool:
        at_once = list(pool.map(lambda mission: tl.fly(mission, "mujoco"), missions))
    for mission, flight in zip(missions, at_once, strict=True):
        assert different(flight, tl.fly(mission, "mujoco")) == []


def test_a_body_goes_when_nothing_holds_it():
    mission = mission_named("paper")
    body = body_file.MuJoCoBody(mission, tl.Vehicle.from_settings(mission.vehicle))
    gone = weakref.ref(body)
    del body
    assert gone() is None


@pytest.mark.thorough
def test_steps_from_python_and_all_at_once_are_the_same():
    mission = mission_named("iris, fallen")
    sim = tl.Simulation(mission, "mujoco")
    while not sim.over:
        sim.step(steps=7)
    flown = tl.fly(mission, "mujoco")
    assert different(sim.flight(), flown) == []
    sim.reset()
    sim.step(steps=mission.mission.steps)
    assert different(sim.flight(), flown) == []


@pytest.mark.parametrize("part", ["decide", "complete"])
def test_ctrl_c_in_a_step_of_a_body_in_python_loses_or_repeats_none(part, in_python, monkeypatch):
    """It comes as soon as machine code returns; a step that has only begun ends the flight."""
    mission = tl.load_mission("one-push", {"mission.duration": 0.3})
    sim = tl.Simulation(mission, "in python")
    sim.step(steps=100)
    held = sim._stepper.code.held

    def interrupted(address, run=held[part]):
        run(address)
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setitem(held, part, interrupted)
        with pytest.raises(KeyboardInterrupt):
            sim.step()
    if part == "decide":
        with pytest.raises(tl.InputError, match=r"interrupted at 0.1 s: KeyboardInterrupt; reset\(\) begins anew"):
            sim.step()
        sim.reset()
    else:
        assert sim.k == 101
    while not sim.over:
        sim.step()
    assert different(sim.flight(), in_python(mission)) == []


# MuJoCo in Python


def without_addresses(monkeypatch):
    monkeypatch.setattr(body_file, "functions_in_c", lambda: mujoco._functions.of_an_unknown_package)


@pytest.mark.parametrize("name", ["iris, fallen", "hover, against a wall", "four, wind"])
def test_without_addresses_of_structs_mujoco_is_called_in_python_and_the_bits_are_the_same(name, monkeypatch):
    mission = mission_named(name)
    flown = tl.fly(mission, "mujoco")
    without_addresses(monkeypatch)
    calls = calls_of_python(lambda: tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}), "mujoco"))
    assert calls["mj_step"] == 101
    assert different(tl.fly(mission, "mujoco"), flown) == []


class Control:
    """A function of the user, which MuJoCo calls in each of the four stages of a step."""

    calls, fails_at = 0, -1

    def __call__(self, model, data):
        self.calls += 1
        if self.calls == self.fails_at:
            raise ArithmeticError("of the user")


@pytest.fixture
def control():
    yield Control()
    mujoco.set_mjcb_control(None)


def test_a_function_of_the_user_in_mujoco_is_called_and_the_flight_is_the_same(control):
    sim, alone = (tl.Simulation("iris", "mujoco") for _ in range(2))
    sim.step(steps=20)
    mujoco.set_mjcb_control(control)
    sim.step(steps=500)
    assert control.calls == 4 * 500
    mujoco.set_mjcb_control(None)
    sim.step(steps=20)
    assert control.calls == 4 * 500
    alone.step(steps=540)
    np.testing.assert_array_equal(sim.state, alone.state)


def test_an_error_of_a_function_of_the_user_comes_out_of_the_step(control):
    sim = tl.Simulation("hover", "mujoco")
    mujoco.set_mjcb_control(control)
    control.fails_at = 150
    with pytest.raises(ArithmeticError, match="of the user"):
        sim.step(steps=500)
    assert sim.k == 38  # 4 calls a step
    assert sim.over
    mujoco.set_mjcb_control(None)
    sim.reset()
    sim.step(steps=500)
    assert np.isfinite(sim.state).all()


def test_a_vehicle_just_above_the_floor_is_never_taken_for_one_out_of_reach(monkeypatch):
    """Fallen from where only the slack keeps it from the floor, it meets it in the same step as with contact always."""
    falling = {"phases.lift_start": 50.0, "initial.velocity": [0.0, 0.0, -15.0], "initial.rates": [9.0, -4.0, 3.0]}
    for height in (0.5, 0.8, 1.2):
        more = {"mission.duration": 0.2, "initial.position": [0.0, 0.0, height], **falling}
        mission = tl.load_mission("iris", {"mission.log_interval": 0.001, **more})
        flown = tl.fly(mission, "mujoco")
        with monkeypatch.context() as patched:
            patched.setattr(
                body_file, "limits_above_floor", lambda model: (np.zeros(3), np.full((2 * model.ngeom, 4), np.inf))
            )
            assert different(flown, tl.fly(mission, "mujoco")) == []
        assert flown["contact_force"].any()
