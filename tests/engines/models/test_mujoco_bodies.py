"""The body in MuJoCo is the vehicle: its mass and inertia, its motion beside the compiled body's, joints, contact."""

import importlib
import sys

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import Absent, Quat, Vec3, each, mat3, vec3
from tandemlift.engines.compiled import advance, start_plant, start_state
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.feet import floor, standing_height, start_foot_grip
from tandemlift.parts.contact.walls import walls
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, resultant
from tandemlift.parts.mechanics.push import CentralPush, PointPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

mujoco = pytest.importorskip("mujoco")
body_file = importlib.import_module("tandemlift.engines.mujoco")
MuJoCoBody = body_file.MuJoCoBody

DT = 0.001
NONE, CALM = np.zeros(3), np.zeros(0)
PLACES = [[0.1, 1.0, 0.075], [-0.2, -1.1, 0.05], [0.9, 0.1, 0.1], [-0.8, 0.2, -0.1]]
DIFFERENT = {  # takes more than the payload has
    "plant.mass_scale": 0.8,
    "plant.inertia_scale": [0.6, 1.3, 2.0],
    "plant.center_of_mass_offset": [0.03, -0.1, 0.02],
}

TURNED = {  # about z, of unlike inertias
    "vehicle.quadrotors.0.heading": 0.6,
    "vehicle.quadrotors.0.inertia": [0.02, 0.035, 0.05],
    "vehicle.quadrotors.2.heading": -2.5,
    "vehicle.quadrotors.2.rotor_positions": [[0.3, 0.1], [-0.1, 0.2], [-0.2, -0.2], [0.1, -0.3]],
}


def mission_of(count=2, changes=None):
    """A mission of `count` unlike quadrotors at unlike places."""
    paper = tl.load_mission("paper").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"][0]
    quadrotors = [{**paper, "position": p, "mass": 1.2 + 0.2 * i} for i, p in enumerate(PLACES[:count])]
    still = {"initial.position": 0.0, "initial.euler": 0.0, "vehicle.quadrotors": quadrotors}
    mission = tl.load_mission("paper", still | (changes or {}))
    return mission, Vehicle.from_settings(mission.vehicle)


def numbers(value):
    """The numbers of a nested value."""
    return np.array([x for part in value for x in numbers(part)] if isinstance(value, tuple) else [value], dtype=float)


def mass_matrix(body):
    """MuJoCo's (6 × 6) at level attitude."""
    M = np.zeros((6, 6))
    mujoco.mj_forward(body.model, body.data)
    mujoco.mj_fullM(body.model, body.data, M)
    return M


@pytest.mark.parametrize("count", [1, 3])
def test_mass_centre_of_mass_and_inertia_are_the_vehicles(count):
    mission, vehicle = mission_of(count)
    body = MuJoCoBody(mission, vehicle)
    expected = np.zeros((6, 6))
    expected[:3, :3], expected[3:, 3:] = vehicle.mass * np.eye(3), vehicle.inertia
    np.testing.assert_allclose(mass_matrix(body), expected, atol=1e-12)  # off the diagonal blocks: m × centre of mass
    payload = body.data.site("payload").xpos
    np.testing.assert_allclose(payload, -vehicle.center_of_mass, atol=1e-15)


def test_the_true_body_has_the_scaled_mass_and_inertia_whatever_is_left_for_the_payload():
    mission, vehicle = mission_of(3, DIFFERENT)
    M, mass = mass_matrix(MuJoCoBody(mission, vehicle)), 0.8 * vehicle.mass
    off = body_file.skew(np.array(mission.plant.center_of_mass_offset))
    np.testing.assert_allclose(M[:3, :3], mass * np.eye(3), atol=1e-12)
    np.testing.assert_allclose(M[3:, 3:], vehicle.real_inertia(mission.plant) - mass * off @ off, atol=1e-12)
    np.testing.assert_allclose(M[:3, 3:], -mass * off, atol=1e-12)


def excited(mission, vehicle, seconds):
    """Fly both bodies with the same thrusts; yields (state, felt) of the compiled one and MuJoCo's body."""
    body, plant, state = (
        MuJoCoBody(mission, vehicle),
        start_plant(mission, vehicle, Absent(), Absent()),
        start_state(mission.initial),
    )
    rng, weight, J = np.random.default_rng(3), vehicle.weight * mission.plant.mass_scale, np.diag(vehicle.inertia)
    phase, rate = rng.uniform(0.0, 6.0, (2, vehicle.rotor_count))
    allocation, push = vehicle.allocation(), PointPush(vec3(NONE), mat3(np.zeros((3, 3))))
    hand, rotors = PushSamples(push, push, push), each(vehicle.rotor_count)
    for k in range(round(seconds / DT)):
        q, w = np.array(state.attitude), np.array(state.rates)
        upright = allocation @ [weight, *(-J * (20.0 * q[1:] + 6.0 * w))]  # or it would tumble within seconds
        thrusts = upright + 0.3 * weight / vehicle.rotor_count * np.sin(rate * k * DT + phase)
        moved = advance(plant, state, Absent(), Absent(), Absent(), rotors(*thrusts), Absent(), hand, DT)
        body.advance(thrusts, CALM, NONE, NONE)
        state = moved.state
        yield state, moved.readings, body


@pytest.mark.thorough
@pytest.mark.parametrize("changes", [DIFFERENT, TURNED], ids=["as it really is", "turned"])
def test_an_excited_vehicle_moves_and_feels_as_in_the_compiled_engine(changes):
    start = {"initial.euler": [0.2, -0.1, 0.4], "initial.velocity": [1.0, 0.5, -0.3], "initial.rates": [1.0, -2.0, 0.5]}
    shoved = {"disturbance.force": [0.3, -0.2, 0.1], "disturbance.moment": [0.02, 0.04, -0.01]}
    mission, vehicle = mission_of(3, start | shoved | changes)
    apart, fastest = np.zeros(2), 0.0
    for state, felt, body in excited(mission, vehicle, 1.5):
        np.testing.assert_allclose(body.readings, numbers(felt), atol=1e-9)
        difference = np.abs(body.state - numbers(state))
        apart = np.maximum(apart, [difference[:3].max(), 2.0 * difference[6:10].max()])
        fastest = max(fastest, np.abs(body.state[10:]).max())
    assert fastest > 1.0  # rad/s: the motion is not a mild one
    assert apart[0] < 1e-9  # m
    assert apart[1] < 1e-10  # rad


def some_state(rng):
    q = rng.standard_normal(4)
    return State(vec3(rng.standard_normal(3)), vec3(rng.standard_normal(3)), Quat(*q / np.linalg.norm(q)), vec3(NONE))


def test_loads_on_the_parts_and_a_push_act_as_their_resultant():
    mission, vehicle = mission_of(4, {"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0})
    rng, rotors = np.random.default_rng(5), np.zeros(16)
    for _ in range(20):
        body, s = MuJoCoBody(mission, vehicle), some_state(rng)
        body.data.qpos[:], body.data.qvel[:] = [*s.position, *s.attitude], [*s.velocity, *s.rates]
        loads, push, moment = rng.standard_normal(30), rng.standard_normal(3), rng.standard_normal(3)
        body.advance(rotors, loads, push, moment)
        sets = [each(4)(*row) for row in loads[6:].reshape(6, 4)]
        parts = PartLoads(PartLoad(vec3(loads[:3]), vec3(loads[3:6])), PartLoad(Vec3(*sets[:3]), Vec3(*sets[3:])))
        all_of_it = resultant(parts_layout_from(vehicle), s.attitude, parts)
        R = np.array(rotation_from_quaternion(s.attitude))
        angular = np.linalg.solve(vehicle.inertia, np.array(all_of_it.moment) + moment)
        force = R.T @ (np.array(all_of_it.force) + push) / vehicle.mass
        expected = force + np.cross(angular, -vehicle.center_of_mass)
        np.testing.assert_allclose(body.readings[:3], expected, atol=1e-9)  # from rest: no centripetal part


def test_what_the_joints_pass_on_accounts_for_the_payloads_motion():
    mission, vehicle = mission_of(3, {"initial.rates": [1.0, -2.0, 0.5], "vehicle.drag.force": 0.0})
    body, rng = MuJoCoBody(mission, vehicle), np.random.default_rng(7)
    body.advance(rng.uniform(0.0, 6.0, 12), np.r_[np.zeros(6), rng.standard_normal(18)], NONE, NONE)
    force, torque = body.readings[3:21].reshape(2, 3, 3)
    payload = vehicle.payload
    np.testing.assert_allclose(force.sum(axis=1), payload.mass * body.readings[:3], atol=1e-12)  # Newton
    mission, vehicle = mission_of(3, {"vehicle.drag.moment": 0.0})
    body = MuJoCoBody(mission, vehicle)
    body.advance(rng.uniform(0.0, 6.0, 12), np.r_[np.zeros(6), rng.standard_normal(18)], NONE, NONE)
    force, torque = body.readings[3:21].reshape(2, 3, 3)
    arms = np.array([q.joint_position for q in vehicle.quadrotors]).T
    about_payload = (torque + np.cross(arms, force, axis=0)).sum(axis=1)
    angular = body.state[10:] / DT  # from rest, over a step
    np.testing.assert_allclose(about_payload, np.array(payload.moments) * angular, rtol=2e-3, atol=1e-4)  # Euler


def test_drag_slows_a_falling_vehicle_as_the_closed_form_says():
    mission, vehicle = mission_of(2, {"vehicle.drag.force": [0.5, 1.0, 2.0], "initial.velocity": [3.0, -2.0, 1.0]})
    body = MuJoCoBody(mission, vehicle)
    for _ in range(1000):
        body.advance(np.zeros(8), CALM, NONE, NONE)
    per_s = np.array([0.5, 1.0, 2.0]) / vehicle.mass
    final = np.array([0.0, 0.0, -GRAVITY]) / per_s
    expected = final + (np.array([3.0, -2.0, 1.0]) - final) * np.exp(-per_s)
    np.testing.assert_allclose(body.state[3:6], expected, atol=1e-10)


SINKAGE, FRICTION = 5e-4, 0.8
LEVEL = {"initial.position": 0.0, "initial.euler": [0.0, 0.0, 0.4]}


def standing(name="four", changes=None):
    """(body, compiled plant's floor, mission, vehicle): a vehicle whose level feet are just on the floor."""
    mission = tl.load_mission(name, LEVEL | (changes or {}))
    vehicle = Vehicle.from_settings(mission.vehicle)
    ground = floor(vehicle, vehicle.mass, DT, friction=FRICTION, sinkage=SINKAGE)
    ground = ground._replace(height=-standing_height(ground, vehicle.weight))
    return MuJoCoBody(mission, vehicle, ground), ground, mission, vehicle


def push_for(body, seconds, force):
    for _ in range(round(seconds / DT)):
        body.advance(np.zeros(len(body.data.ctrl)), CALM, np.array(force), NONE)


def test_a_vehicle_at_rest_sinks_by_its_weight_over_the_stiffness_of_its_feet():
    body, ground, _, vehicle = standing(changes={"initial.position": [0.0, 0.0, 1e-3]})
    push_for(body, 2.0, NONE)
    lowest = body.state[2] + vehicle.lever_arms[:, 2].min() - 0.18
    assert ground.height - lowest == pytest.approx(SINKAGE, abs=1e-9)
    assert np.abs(body.state[3:6]).max() < 1e-7  # m/s
    np.testing.assert_allclose(body.readings[-3:], [0.0, 0.0, vehicle.weight], atol=1e-4)
    np.testing.assert_allclose(body.readings[:3], [0.0, 0.0, GRAVITY], atol=1e-4)
    carried = vehicle.payload.mass * GRAVITY / 4.0  # the feet carry quadrotors directly, the joints only the payload
    np.testing.assert_allclose(body.readings[11:15], carried, atol=1e-3)


def test_friction_holds_below_its_limit_and_yields_above_it():
    body, _, _, vehicle = standing()
    limit = FRICTION * vehicle.weight
    push_for(body, 0.5, [0.9 * limit, 0.0, 0.0])
    before = body.state.copy()
    push_for(body, 1.0, [0.9 * limit, 0.0, 0.0])
    assert np.abs(body.state - before)[:2].max() < 1e-4  # m of creep in a second
    push_for(body, 0.2, [1.2 * limit, 0.0, 0.0])
    before = body.state.copy()
    push_for(body, 0.5, [1.2 * limit, 0.0, 0.0])
    gained = (body.state - before)[3]
    assert gained == pytest.approx(0.5 * 0.2 * FRICTION * GRAVITY, rel=0.02)


@pytest.mark.thorough
def test_a_crooked_landing_goes_as_in_the_compiled_engine():
    fall = {
        "initial.euler": [0.02, -0.015, 0.3],
        "initial.position": [0.0, 0.0, 0.03],
        "initial.velocity": [0.2, 0.2, 0.2],
    }
    body, ground, mission, vehicle = standing("paper", fall)
    state, plant = start_state(mission.initial), start_plant(mission, vehicle, ground, Absent())
    grip, off, still = start_foot_grip(ground, state), each(8)(*[0.0] * 8), CentralPush(vec3(NONE))
    apart = []
    for _ in range(600):
        moved = advance(plant, state, Absent(), grip, Absent(), off, Absent(), PushSamples(still, still, still), DT)
        state, grip = moved.state, moved.grip
        body.advance(np.zeros(8), CALM, NONE, NONE)
        apart.append(np.abs(body.state - numbers(state))[:3])
    assert np.max(apart) < 1e-3  # m, while it slides and rocks: friction holds and yields differently
    assert apart[-1][2] < 1e-8  # m, at rest


@pytest.mark.parametrize(
    ("wall", "force", "touching"),
    [
        (([1.0, -3.0], [1.0, 3.0]), [8.0, 0.0, 0.0], 2),  # both guards
        (([-3.0, 2.0], [3.0, 2.0]), [0.0, 8.0, 0.0], 1),  # the guard ahead
        (([0.5, 0.0], [0.7, 0.0]), [8.0, 0.0, 0.0], 2),  # the beam, along its two contacts with the end of a wall
    ],
)
def test_a_vehicle_pressed_against_a_wall_yields_by_the_force_over_the_stiffness(wall, force, touching):
    changes = {
        "vehicle.drag.force": 20.0,
        "ground.model": "floor",
        "walls": [{"start": wall[0], "end": wall[1], "top": 2.0}],
    }
    mission = tl.load_mission("paper", {"initial.position": 0.0, "initial.euler": 0.0} | changes)
    vehicle = Vehicle.from_settings(mission.vehicle)
    J, press = vehicle.inertia, walls(vehicle, vehicle.mass, DT, friction=0.0, stiffness=2000.0)
    body, allocation = MuJoCoBody(mission, vehicle, walls=press), vehicle.allocation()
    for _ in range(6000):
        q, w = body.state[6:10], body.state[10:]
        lift = (vehicle.weight - 200.0 * body.state[2] - 100.0 * body.state[5]) / (1.0 - 2.0 * (q[1] ** 2 + q[2] ** 2))
        moment = -np.diag(J) * (400.0 * q[1:] + 30.0 * w)
        body.advance(allocation @ [lift, *moment], CALM, np.array(force), NONE)
    contacts = body.data.contact
    assert len(contacts) == touching
    pressed = press.springs.stiffness * sum(-contact.dist for contact in contacts)
    assert pressed == pytest.approx(np.linalg.norm(body.readings[-3:]), rel=1e-3)
    assert np.array(force) @ body.readings[-3:] < 0.0  # the wall pushes back


def test_a_command_that_is_none_ends_the_motion_without_a_word(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    for command in (np.nan, np.inf, -1e12):
        body = MuJoCoBody(*mission_of(2))
        body.advance(np.full(8, command), CALM, NONE, NONE)
        assert np.isnan([*body.state, *body.readings]).all()
    assert not list(tmp_path.iterdir())  # MuJoCo would write a log
    assert capfd.readouterr() == ("", "")


def test_without_mujoco_one_sentence_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    for name in ("bodies", "contact", "import"):
        monkeypatch.delitem(sys.modules, f"tandemlift.engines.models.mujoco_{name}")
    with pytest.raises(tl.InputError, match=r"^engine 'mujoco' needs mujoco: pip install 'tandemlift\["):
        importlib.import_module("tandemlift.engines.models.mujoco_bodies")


@pytest.mark.parametrize(
    "line",
    [
        "raise ImportError('its core bindings are missing:\\n  pip install --force-reinstall mujoco')",
        "import mujoco._nothing_of_it",
    ],
)
def test_a_mujoco_that_is_broken_is_told_with_its_own_line(line, monkeypatch, tmp_path):
    (tmp_path / "mujoco").mkdir()
    (tmp_path / "mujoco" / "__init__.py").write_text(line)
    monkeypatch.syspath_prepend(tmp_path)
    for name in [n for n in sys.modules if n.split(".")[0] == "mujoco"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delitem(sys.modules, "tandemlift.engines.models.mujoco_import")
    with pytest.raises(tl.InputError, match="installed but cannot be imported: ") as caught:
        importlib.import_module("tandemlift.engines.models.mujoco_import")
    assert ("--force-reinstall" in str(caught.value)) == ("bindings" in line)
    assert "\n" not in str(caught.value)


def test_mujoco_3_is_to_be_uninstalled_first(monkeypatch):
    monkeypatch.setattr(mujoco, "__version__", "3.17.0")
    monkeypatch.delitem(sys.modules, "tandemlift.engines.models.mujoco_import")
    with pytest.raises(tl.InputError, match=r"3\.17\.0 is installed: pip uninstall -y mujoco, then pip install 'tand"):
        importlib.import_module("tandemlift.engines.models.mujoco_import")
