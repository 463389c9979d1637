"""Missions as MuJoCo models, read by MuJoCo: the vehicle, and its flight beside the engine's own."""

import importlib

import numpy as np
import pytest
from modelled import BUILT_IN, MISSIONS, loaded

import tandemlift as tl
from tandemlift.engines.models.scene import floor_from, walls_from


def flown_beside_the_engine(mujoco, model, mission, vehicle, thrusts, steps):
    """The largest difference of state and sensors between a model and the engine's body of a mission [SI]."""
    body = importlib.import_module("tandemlift.engines.mujoco").MuJoCoBody(
        mission, vehicle, floor_from(mission, vehicle), walls_from(mission, vehicle)
    )
    data, calm, none = mujoco.MjData(model), np.zeros(0), np.zeros(3)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    data.ctrl[: len(thrusts)], worst = thrusts, 0.0
    for _ in range(steps):
        body.advance(thrusts, calm, none, none)
        mujoco.mj_step(model, data)
        state = np.concatenate([data.qpos[:3], data.qvel[:3], data.qpos[3:], data.qvel[3:]])
        worst = max(worst, np.abs(state - body.state).max(), np.abs(data.sensordata - body.data.sensordata).max())
    return worst


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("one", {}),
        ("unlike", {"initial.velocity": [1.0, -2.0, 0.5], "initial.rates": [0.4, -0.3, 1.0]}),
        *((name, {}) for name in BUILT_IN),
        ("as it really is", {"vehicle.drag.force": [0.1, 0.2, 0.3], "vehicle.drag.moment": [0.03, 0.02, 0.01]}),
        ("walls", {"initial.position": [1.7, 0.0, 0.02], "initial.velocity": [1.0, 0.0, 0.0]}),
    ],
)
def test_a_mujoco_model_flies_and_feels_as_the_engine(name, more, mujoco, model_of):
    mission, vehicle = loaded(name, more)
    thrusts = np.full(vehicle.rotor_count, vehicle.weight / vehicle.rotor_count)
    thrusts *= np.linspace(0.9, 1.05, vehicle.rotor_count)
    assert flown_beside_the_engine(mujoco, model_of(mission), mission, vehicle, thrusts, 400) < 1e-8


def test_a_hovering_vehicle_carries_half_the_beam_at_each_joint(mujoco, model_of):
    model = model_of(tl.load_mission("paper", {"initial.position": 0.0, "initial.euler": 0.0}))
    data, lift = mujoco.MjData(model), 3.5 * 9.81 / 2.0
    data.ctrl[:] = lift / 4.0
    mujoco.mj_step(model, data)
    for i in (1, 2):  # the sensor knows nothing of what the rotors make
        np.testing.assert_allclose(lift - data.sensor(f"force{i}").data[2], 0.25 * 9.81, rtol=1e-12)


def is_believed(name):
    """Whether the true vehicle is the pilot's; what it has more, a file gives to the payload, the engine to a body.

    Its drag must be equal along all axes: a file writes other drag as actuators.
    """
    mission, vehicle = loaded(name)
    plant, drag = mission.plant, vehicle.drag
    return (
        plant.mass_scale == 1.0
        and set(plant.inertia_scale) == {1.0}
        and len(set(drag.force)) == len(set(drag.moment)) == 1
    )


@pytest.mark.parametrize("name", [name for name in MISSIONS if is_believed(name)])
def test_numbers_of_a_mujoco_model_are_the_engines_to_the_last_digits(name, mujoco, model_of):
    mission, vehicle = loaded(name)
    ours, engine = model_of(mission), importlib.import_module("tandemlift.engines.models.mujoco_bodies")
    theirs = engine.model_of(mission, vehicle, floor_from(mission, vehicle), walls_from(mission, vehicle))
    same = ("body_mass", "body_inertia", "body_ipos", "site_pos", "actuator_gear", "dof_damping", "pair_friction")
    for array in same:
        np.testing.assert_allclose(getattr(ours, array), getattr(theirs, array), rtol=1e-15, atol=1e-15)
    for array in ("pair_solref", "pair_solreffriction"):
        np.testing.assert_allclose(getattr(ours, array), getattr(theirs, array), rtol=1e-12)
    touching = [mujoco.mj_id2name(theirs, mujoco.mjtObj.mjOBJ_GEOM, i) for i in range(theirs.ngeom)]
    for geom in touching:
        np.testing.assert_allclose(ours.geom(geom).pos, theirs.geom(geom).pos, rtol=1e-15, atol=1e-15)
        np.testing.assert_allclose(ours.geom(geom).size, theirs.geom(geom).size, rtol=1e-15)
    assert not ours.geom_contype.any()
    assert not ours.geom_conaffinity.any()  # shapes touch in pairs only, those to look at never
    np.testing.assert_array_equal(ours.key("start").qpos[:3], mission.initial.position)
    np.testing.assert_array_equal(ours.qpos0[:3], mission.initial.position)
