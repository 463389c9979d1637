"""The elastic vehicle beside a chain of rigid segments on sprung hinges in MuJoCo, which knows nothing of modes."""

from __future__ import annotations

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import Absent, each, outer, several, vec3
from tandemlift.engines.compiled import advance, start_plant, start_state
from tandemlift.parts.mechanics.push import PointPush, PushSamples, on_beam
from tandemlift.parts.mechanics.structure import Deformation, shape_channels
from tandemlift.parts.mechanics.structure_modes import modes_of
from tandemlift.parts.mechanics.vehicle import Vehicle

mujoco = pytest.importorskip("mujoco")

SEGMENTS, FINE, STEP = 16, 2e-5, 1e-3  # s: MuJoCo's step, and that of the modes
PROPORTIONAL = 1.5e-4  # s: damping of a hinge over its stiffness
KEYS = {
    **{"vehicle.payload.material": "pine", "vehicle.payload.radius": 0.011, "vehicle.payload.modes": 12},
    **{"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0, "initial.position": [0.0, 0.0, 0.5]},
}
POINT, PUSH = np.array([0.0, 0.7, 0.0]), np.array([1.0, 2.0, 0.0])  # m, N


class Chain:
    """Half a segment at each end, whole ones between, a hinge about each axis in their middles."""

    def __init__(self, vehicle):
        self.vehicle, payload = vehicle, vehicle.payload
        (bending, torsional), length = payload.stiffnesses, payload.length
        h, gyration = length / SEGMENTS, np.sqrt(payload.round_section.gyration_squared)
        self.edges = [-0.5 * length, *(-0.5 * length + (i + 0.5) * h for i in range(SEGMENTS)), 0.5 * length]
        springs = (("1 0 0", bending), ("0 0 1", bending), ("0 1 0", torsional))
        hinges = "".join(
            f'<joint type="hinge" axis="{axis}" stiffness="{k / h}" damping="{PROPORTIONAL * k / h}"/>'
            for axis, k in springs
        )

        def segment(i):
            start, size = self.edges[i], self.edges[i + 1] - self.edges[i]
            mass = payload.mass * size / length
            across, along = mass * (size**2 / 12.0 + gyration**2), 2.0 * mass * gyration**2
            text = f'<inertial pos="0 {size / 2} 0" mass="{mass}" diaginertia="{across} {along} {across}"/>'
            for n, q in enumerate(vehicle.quadrotors):
                if self.at(q.joint_position[1]) == i:
                    x, y, z = q.position
                    text += f'<body name="q{n}" pos="{x} {y - start} {z}"><inertial pos="0 0 0" mass="{q.mass}" '
                    text += f'diaginertia="{" ".join(map(str, q.inertia))}"/></body>'
            more = f'<body name="s{i + 1}" pos="0 {size} 0">{hinges}{segment(i + 1)}</body>' if i < SEGMENTS else ""
            return text + more

        option = f'<option gravity="0 0 -9.81" timestep="{FINE}" integrator="RK4"/>'
        root = f'<body name="s0" pos="0 {-0.5 * length} 0.5"><freejoint/>{segment(0)}</body>'
        self.model = mujoco.MjModel.from_xml_string(f"<mujoco>{option}<worldbody>{root}</worldbody></mujoco>")
        self.data = mujoco.MjData(self.model)
        self.quadrotors = [self.model.body(f"q{n}").id for n in range(vehicle.count)]
        self.middle, self.pushed = (self.model.body(f"s{self.at(y)}").id for y in (0.0, POINT[1]))

    def at(self, y):
        """The number of the segment at a place on the beam."""
        return max(i for i in range(SEGMENTS + 1) if self.edges[i] <= y + 1e-9)

    def frequencies(self):
        """Those of the chain at rest, straight."""
        n = self.model.nv
        mass, stiffness = np.zeros((n, n)), np.zeros(n)
        mujoco.mj_forward(self.model, self.data)
        mujoco.mj_fullM(self.model, self.data, mass)
        stiffness[6:] = self.model.jnt_stiffness[1:]
        inverse = np.linalg.inv(np.linalg.cholesky(mass))
        return np.sqrt(np.abs(np.linalg.eigvalsh(inverse @ np.diag(stiffness) @ inverse.T)))[6:]

    def shape(self):
        """Deflection (N × 3) and slope (N × 3) of the quadrotors, from the middle of the beam; its position (3)."""
        mujoco.mj_kinematics(self.model, self.data)
        d, R = self.data, self.data.xmat[self.middle].reshape(3, 3)
        middle = d.xpos[self.middle] - R @ [0.0, self.edges[self.at(0.0)], 0.0]
        away = [R.T @ (d.xipos[i] - middle) for i in self.quadrotors]
        turns = [R.T @ d.xmat[i].reshape(3, 3) for i in self.quadrotors]
        slopes = [0.5 * np.array([t[2, 1] - t[1, 2], t[0, 2] - t[2, 0], t[1, 0] - t[0, 1]]) for t in turns]
        return np.array(away) - [q.position for q in self.vehicle.quadrotors], np.array(slopes), middle

    def advance(self, thrusts, force):
        """One step of the modes under thrusts and a push."""
        d = self.data
        for _ in range(round(STEP / FINE)):
            mujoco.mj_kinematics(self.model, d)
            d.xfrc_applied[:] = 0.0
            for n, i in enumerate(self.quadrotors):
                q, u, R = self.vehicle.quadrotors[n], thrusts[4 * n : 4 * n + 4], d.xmat[i].reshape(3, 3)
                x, y = np.array(q.rotors).T
                moment = [y @ u, -x @ u, q.torque_per_thrust * np.array(q.spins) @ u]
                d.xfrc_applied[i] = [*(R[:, 2] * u.sum()), *(R @ moment)]
            i = self.pushed
            at = d.xpos[i] + d.xmat[i].reshape(3, 3) @ [0.0, POINT[1] - self.edges[self.at(POINT[1])], 0.0]
            d.xfrc_applied[i] += [*force, *np.cross(at - d.xipos[i], force)]
            mujoco.mj_step(self.model, d)


def commands(hover, steps):
    """Thrusts (steps, 8) with the lag of rotors: a ramp to hover, then collective, roll and pitch of single ones."""
    thrusts, x = [], np.zeros(8)
    for k in range(steps):
        t, asked = k * STEP, np.full(8, hover * min(k * STEP / 0.3, 1.0))
        asked[:4] += 1.0 * (0.4 < t < 0.5)
        asked[4:] += np.array([1.0, -0.5, 0.3, 0.8]) * (0.6 < t < 0.7)
        x = x + (asked - x) * (1.0 - np.exp(-STEP / 0.02))
        thrusts.append(x)
    return np.array(thrusts)


@pytest.fixture(scope="module")
def both():
    """A mission with a pine rod, its vehicle, and the chain."""
    mission = tl.load_mission("iris", KEYS)
    vehicle = Vehicle.from_settings(mission.vehicle)
    return mission, vehicle, Chain(vehicle)


def test_the_first_six_frequencies_are_those_of_the_chain(both):
    _, vehicle, chain = both
    np.testing.assert_allclose(modes_of(vehicle).frequency[:6], chain.frequencies()[:6], rtol=0.01)


@pytest.mark.thorough
def test_the_elastic_vehicle_moves_as_the_chain_does(both):
    mission, vehicle, chain = both
    plant, state, steps = start_plant(mission, vehicle, Absent(), Absent()), start_state(mission.initial), 900
    k = plant.structure
    n = len(k.stiffness)
    plant = plant._replace(structure=k._replace(damping=several(n)(*[PROPORTIONAL * w for w in k.stiffness])))
    shape = Deformation(several(n)(*[0.0] * n), several(n)(*[0.0] * n))
    state = state._replace(position=vec3(-vehicle.origin + [0.0, 0.0, 0.5]))
    told = []
    for step, thrusts in enumerate(commands(vehicle.weight / 8.0, steps)):
        force = PUSH * np.exp(-0.5 * ((step - 600) / 60.0) ** 2)
        there = vec3(POINT + vehicle.origin)
        push = on_beam(PointPush(vec3(force), outer(vec3(force), there)), there)
        mine = [np.array(x).T for x in shape_channels(plant.structure, shape)]
        told.append([np.vstack(mine), np.vstack(chain.shape()[:2])])
        moved = advance(
            plant, state, shape, Absent(), Absent(), each(8)(*thrusts), Absent(), PushSamples(push, push, push), STEP
        )
        chain.advance(thrusts, force)
        state, shape = moved.state, moved.shape
    ours, theirs = np.array(told).transpose(1, 2, 3, 0)
    rms = lambda x: np.sqrt(np.mean(np.square(x), axis=-1))  # noqa: E731
    size, off = rms(theirs), rms(ours - theirs)
    assert size[0, 2] > 2e-3, "it bends by millimetres"
    large = size > 0.3 * np.repeat([size[:2].max(), size[2:].max()], 2)[:, None]
    assert large.sum() >= 5
    np.testing.assert_array_less(off[large] / size[large], 0.03)
    np.testing.assert_allclose(state.position, chain.data.subtree_com[1], atol=1e-3)
