"""A vehicle whose beam bends and whose mounts give: its modes, and their motion beside that of the rigid body."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.optimize import brentq

import tandemlift as tl
from tandemlift.core.vector import Absent, each, outer, several, vec3
from tandemlift.engines.compiled import advance, start_plant, start_shape, start_state
from tandemlift.parts.mechanics.push import BeamPush, PointPush, PushSamples, on_beam, pushed_at
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.structure import (
    Deformation,
    kept_modes,
    mode_in_words,
    structure_of,
    work_of_push,
)
from tandemlift.parts.mechanics.structure_modes import ELEMENTS, modes_of
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable

M, J = 1.5, 0.029  # kg, kg m²: of a quadrotor
TUBE = {"section": "tube"}
BEAMS = {  # of 2 m
    "cfrp 30 x 1": {"material": "cfrp", **TUBE, "radius": 0.015, "wall": 0.001},
    "cfrp 16 x 1": {"material": "cfrp", **TUBE, "radius": 0.008, "wall": 0.001},
    "aluminium 25 x 1": {"material": "aluminium", **TUBE, "radius": 0.0125, "wall": 0.001},
    "pine 22": {"material": "pine", "radius": 0.011},
    "pvc 32 x 1.8": {"material": "pvc", **TUBE, "radius": 0.016, "wall": 0.0018},
    "foam 100": {"material": "foam", "radius": 0.05, "mass": 0.5},
}
PINE = {"vehicle.payload.material": "pine", "vehicle.payload.radius": 0.011}
QUADROTOR = {
    **{"mass": M, "inertia": [J, J, J], "arm": 0.25, "thrust_constant": 5.84e-6, "max_speed": 1100.0},
    **{"torque_per_thrust": 0.06, "lag_up": 0.0125, "lag_down": 0.025},
}


def vehicle_of(payload, height=0.0, **more):
    ends = [QUADROTOR | {"position": [0.0, y, height]} | more for y in (1.0, -1.0)]
    table = {"payload": {"length": 2.0} | payload, "quadrotors": ends}
    return Vehicle.from_settings(VehicleTable.model_validate(table))


def closed_form(vehicle, count=3):
    """The first bending frequencies [rad/s] of a slender beam with rigid bodies at its ends, from its end conditions.

    E I w'' = ω² J w', −E I w''' = ω² m w at y = l, with β⁴ = μ ω²/(E I), for symmetric and antisymmetric shapes.
    """
    (bending, _), per_length, half = vehicle.payload.stiffnesses, vehicle.payload.mass / 2.0, 1.0
    found = []
    for even in (True, False):

        def determinant(w, even=even):
            b = (per_length * w * w / bending) ** 0.25
            c, s, ch, sh = np.cos(b * half), np.sin(b * half), np.cosh(b * half), np.sinh(b * half)
            rows = [(c, -s, -c, s), (ch, sh, ch, sh)] if even else [(s, c, -s, -c), (sh, ch, sh, ch)]
            shapes = [tuple(x * b**n for n, x in enumerate(row)) for row in rows]
            moment = [bending * x[2] - w * w * J * x[1] for x in shapes]
            force = [-bending * x[3] - w * w * M * x[0] for x in shapes]
            return moment[0] * force[1] - moment[1] * force[0]

        grid = np.linspace(5.0, 800.0, 4000)
        values = [determinant(w) for w in grid]
        crossings = [i for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0.0]
        found += [brentq(determinant, grid[i], grid[i + 1], xtol=1e-12) for i in crossings[:count]]
    return sorted(found)[:count]


@pytest.mark.parametrize("beam", BEAMS)
def test_a_beam_bends_at_the_frequencies_of_its_end_conditions_in_both_planes(beam):
    vehicle = vehicle_of(BEAMS[beam])
    modes = modes_of(vehicle, ELEMENTS, True)
    bends = [w for i, w in enumerate(modes.frequency[:8]) if "twists" not in mode_in_words(modes, i)]
    np.testing.assert_allclose(bends[:6:2], closed_form(vehicle), rtol=1e-5)
    np.testing.assert_allclose(bends[1:6:2], closed_form(vehicle), rtol=1e-5)


@pytest.mark.parametrize("beam", BEAMS)
def test_a_light_beam_twists_as_a_spring_between_its_ends(beam):
    vehicle = vehicle_of(BEAMS[beam])
    modes = modes_of(vehicle)
    twist = next(w for i, w in enumerate(modes.frequency) if "twists" in mode_in_words(modes, i))
    (_, torsional), beam_inertia = vehicle.payload.stiffnesses, vehicle.payload.moments[1]
    # a third of the beam's inertia at each end of a half that is clamped in its middle
    assert twist == pytest.approx(math.sqrt(torsional / (J + beam_inertia / 6.0)), rel=1e-4)


def test_the_frequencies_converge_with_the_fourth_order_of_the_elements():
    vehicle = vehicle_of(BEAMS["pine 22"])
    exact = closed_form(vehicle)[-1]
    errors = [modes_of(vehicle, n, True).frequency[5] / exact - 1.0 for n in (4, 8, 16)]
    order = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(order, 4.0, atol=0.15)


def test_a_mount_that_gives_is_a_spring_between_two_bodies():
    stiff = [1e9, 1e9, 1e9, 1e9, 50.0, 1e9]  # about y alone
    vehicle = vehicle_of({"mass": 1.0, "radius": 0.05, "inertia": [0.3, 0.02, 0.3]}, joint_stiffness=stiff)
    modes = modes_of(vehicle)
    # two ends against each other with the payload at rest; both against the payload
    expected = [math.sqrt(50.0 / J), math.sqrt(50.0 * (1.0 / J + 2.0 / 0.02))]
    np.testing.assert_allclose(modes.frequency[:2], expected, rtol=1e-6)
    np.testing.assert_allclose(modes.damping[:2], 0.05, rtol=1e-6)
    np.testing.assert_allclose(modes.mounts[:2], 1.0, rtol=1e-6)
    assert mode_in_words(modes, 0) == "mounts give, payload twists, ends against each other"


def test_modes_carry_no_momentum_and_no_angular_momentum():
    vehicle = vehicle_of(BEAMS["pine 22"], height=0.075)
    modes = modes_of(vehicle)
    y, payload = modes.stations, modes.payload
    density = vehicle.payload.mass / 2.0
    low = slice(0, 6)
    momentum = density * simpson(payload.displacement, x=y, axis=0)[:, low]
    momentum = momentum + M * modes.quadrotors.displacement.sum(axis=0)[:, low]
    scale = M * np.abs(modes.quadrotors.displacement[..., low]).max()
    assert np.abs(momentum).max() < 1e-4 * scale
    places = np.column_stack([np.zeros_like(y), y, np.zeros_like(y)])
    own = np.cross(places[:, :, None], payload.displacement, axis=1)
    turning = density * simpson(own, x=y, axis=0)[:, low]
    for q, d, turn in zip(vehicle.quadrotors, modes.quadrotors.displacement, modes.quadrotors.rotation, strict=True):
        turning = turning + M * np.cross(q.position, d, axis=0)[:, low] + (q.tensor @ turn)[:, low]
    assert np.abs(turning).max() < 1e-3 * J * np.abs(modes.quadrotors.rotation[..., low]).max()


def flexed(mission, keys=None):
    """A mission's body in free air, its vehicle and its state at the start."""
    loaded = tl.load_mission(mission, {**PINE, **(keys or {})})
    vehicle = Vehicle.from_settings(loaded.vehicle)
    return start_plant(loaded, vehicle, Absent(), Absent()), vehicle, start_state(loaded.initial)


def still(force=(0.0, 0.0, 0.0), point=(0.0, 0.0, 0.0)):
    push = on_beam(PointPush(vec3(force), outer(vec3(force), vec3(point))), vec3(point))
    return PushSamples(push, push, push)


def test_a_hovering_beam_droops_as_one_on_two_supports_under_its_weight():
    plant, vehicle, state = flexed("iris", {"mission.step": 1e-4, "vehicle.payload.modes": 12})
    thrusts = each(8)(*[vehicle.weight / 8.0] * 8)
    shape = start_shape(plant, state, Absent(), Absent(), thrusts, still())
    k = plant.structure
    deflection = sum(np.array(d)[2] * q for d, q in zip(k.bent.displacement, shape.coordinates, strict=True))
    slope = sum(np.array(d)[0] * q for d, q in zip(k.bent.rotation, shape.coordinates, strict=True))
    load, length = vehicle.payload.mass * 9.81 / 2.0, 2.0
    bending, _ = vehicle.payload.stiffnesses
    np.testing.assert_allclose(deflection, 5.0 * load * length**4 / (384.0 * bending), rtol=0.01)
    np.testing.assert_allclose(np.abs(slope), load * length**3 / (24.0 * bending), rtol=0.01)


def test_a_free_mode_converges_with_the_fourth_order_of_the_step():
    plant, _, state = flexed("iris")
    k, off = plant.structure, each(8)(*[0.0] * 8)
    n = len(k.stiffness)
    begun = Deformation(several(n)(*[0.01] * n), several(n)(*[0.0] * n))
    w, half = np.sqrt(np.array(k.stiffness)), 0.5 * np.array(k.damping)
    turning = np.sqrt(w**2 - half**2)
    exact = 0.01 * np.exp(-half * 0.1) * (np.cos(0.1 * turning) + half / turning * np.sin(0.1 * turning))
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        s, shape = state, begun
        for _ in range(round(0.1 / step)):
            moved = advance(plant, s, shape, Absent(), Absent(), off, Absent(), still(), step)
            s, shape = moved.state, moved.shape
        errors.append(np.abs(np.array(shape.coordinates) - exact)[:3])
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 4.0, atol=0.3)
    falls = State(*(np.array(x) for x in s))
    assert falls.velocity[2] == pytest.approx(-0.981, rel=1e-3)  # and falls as if it were rigid


def test_a_push_works_on_a_mode_by_the_shape_at_its_point():
    plant, vehicle, state = flexed("iris")
    modes = kept_modes(vehicle, 1e-3)
    for y in (-1.0, -0.5, 0.0, 0.25, 0.75, 1.0):
        point = np.array([0.0, y, 0.0]) + vehicle.origin
        work = work_of_push(still((0.3, 0.0, 1.0), point).start, plant.structure, state.attitude)
        there = modes.payload.displacement[np.argmin(np.abs(modes.stations - y))]
        size = np.abs(modes.payload.displacement).max(axis=(0, 1))
        np.testing.assert_array_less(np.abs(np.array(work) - (0.3 * there[0] + there[2]))[:5] / size[:5], 0.03)


def test_a_push_of_a_kind_keeps_its_kind():
    push = PointPush(vec3([1.0, 2.0, 3.0]), outer(vec3([1.0, 2.0, 3.0]), vec3([0.1, 2.0, 0.0])))
    assert pushed_at(push, push, vec3([0.1, 2.0, 0.0])) is push
    on = pushed_at(still().start, push, vec3([0.1, 2.0, 0.0]))
    assert isinstance(on, BeamPush)
    assert tuple(on.third) == (8.0, 16.0, 24.0)


def test_a_rigid_vehicle_has_no_structure_and_a_stiff_one_flies_as_if_it_were_rigid():
    rigid = tl.load_mission("iris", {"mission.duration": 8.0})
    assert isinstance(structure_of(Vehicle.from_settings(rigid.vehicle), 1e-3), Absent)
    keys = {"bending_stiffness": 2.4e4, "torsional_stiffness": 2.4e4, "damping": 0.2, "modes": 3}
    stiff = {f"vehicle.payload.{name}": value for name, value in keys.items()}
    flights = [
        tl.fly(tl.load_mission("iris", {"mission.duration": 8.0, **c, "mission.step": 5e-4})) for c in ({}, stiff)
    ]
    assert np.abs(flights[0]["position"] - flights[1]["position"]).max() < 2e-3
    assert np.abs(flights[1]["deflection"]).max() < 2e-4
    assert "deflection" not in flights[0].channels


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"section": "tube"}, "wall"),
        ({"section": "tube", "wall": 0.05}, "below the radius"),
        ({"wall": 0.001}, 'section = "tube"'),
        ({"bending_stiffness": 10.0}, "torsional_stiffness"),
        ({"damping": 0.1}, "no damping without material"),
        ({"material": "pine", "inertia": [0.1, 0.01, 0.1]}, "no inertia"),
        ({"material": "pine", "center_of_mass": [0.0, 0.1, 0.0]}, "center_of_mass"),
        ({"material": "oak"}, '"pine"'),
        ({"material": "pine", "bending_stiffness": 0.0, "torsional_stiffness": 1.0}, "bending_stiffness"),
        ({"material": "steel"}, "mission.step"),
    ],
)
def test_a_beam_that_cannot_be_is_refused_by_its_key(keys, said):
    with pytest.raises(tl.InputError) as refused:
        tl.load_mission("iris", {f"vehicle.payload.{name}": value for name, value in keys.items()})
    assert said in str(refused.value)


def test_a_linear_model_knows_what_a_push_does_to_a_mode():
    mission = tl.load_mission("iris", {**PINE, "sensors.model": "none", "pilot.state": "truth", "pilot.push": "truth"})
    model = tl.linearize(mission, 6.0, of="body", inputs=["push_force"])
    k = structure_of(Vehicle.from_settings(mission.vehicle), 1e-3)
    rows = {v.name: row for v, row in zip(model.states, model.B, strict=True)}
    for i in range(3):  # a step of 1 ms is short for the slow ones
        expected = 1e-3 * np.array(k.along.linear.displacement[i])
        np.testing.assert_allclose(rows[f"shape.rates.n{i}"], expected, atol=1e-3 * np.abs(expected).max() + 1e-7)


def test_identification_refuses_a_beam_that_bends():
    with pytest.raises(tl.InputError, match=r"vehicle\.payload.*rigid"):
        tl.identify(tl.fly(tl.load_mission("iris", {**PINE, "mission.duration": 1.0})), tl.load_mission("iris", PINE))


def test_other_engines_refuse_a_beam_that_bends():
    with pytest.raises(tl.InputError, match=r"engine 'mujoco'.*vehicle\.payload\.material"):
        tl.fly(tl.load_mission("iris", PINE), "mujoco")


def test_a_material_and_a_section_give_a_beam_its_mass():
    vehicle = vehicle_of(BEAMS["cfrp 30 x 1"])
    assert vehicle.payload.mass == pytest.approx(1600.0 * math.pi * (0.015**2 - 0.014**2) * 2.0)
    own = vehicle_of(BEAMS["cfrp 30 x 1"] | {"mass": 0.31}).payload
    assert own.mass == 0.31
    assert own.moments[1] == pytest.approx(0.31 * 0.5 * (0.015**2 + 0.014**2))


@pytest.mark.thorough
def test_a_wooden_beam_shakes_and_is_said_to_before_and_after():
    shaken = tl.load_mission("iris", {**PINE, "mission.duration": 20.0})
    found = [r for r in tl.check(shaken) if r.check == "structure" and r.verdict == "fails"]
    assert any("bends up and down, ends together" in r.subject for r in found)
    finding = next(f for f in tl.fly(shaken).findings if f.kind == "structure-oscillates")
    assert finding.value > 4.0 * finding.limit


@pytest.mark.thorough
def test_notches_calm_a_wooden_beam_and_check_knows():
    def notch(frequency, axis, width):
        return {"frequency": frequency, "axes": [axis], "width": width, "depth": 0.0}

    notches = [notch(40.5, "thrust", 0.7), notch(158.0, "pitch", 0.15), notch(76.4, "yaw", 0.7)]
    keys = {**PINE, "allocation.notches": notches, "mission.duration": 20.0, "pushes": [], "phases.land_start": None}
    calm = tl.load_mission("iris", keys)
    assert [r.text for r in tl.check(calm) if r.check == "structure" and r.verdict == "fails"] == []
    flight = tl.fly(calm)
    assert [f.kind for f in flight.findings] == []
    flies = flight.time > 12.0
    rigid = tl.fly(tl.load_mission("iris", {k: v for k, v in keys.items() if "vehicle" not in k and "alloc" not in k}))
    assert flight["rotor_thrusts"][flies].std(axis=0).mean() < 1.5 * rigid["rotor_thrusts"][flies].std(axis=0).mean()
