"""The mesh of a vehicle in body axes, with the origin at the system's centre of mass and the sizes of the mission.

The front rotors of a quadrotor are orange and the rear ones blue, so that its heading is visible.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.common.types import Array
from tandemlift.rendering.mesh import Mesh, box, cylinder, disc, merged, revolved, sphere, torus
from tandemlift.settings import Quadrotor
from tandemlift.vehicle import Vehicle

CARBON, METAL, SHELL, WOOD = "#2b2f36", "#8d949e", "#d9dce0", "#c2853f"
FRONT, REAR, JOINT, GUARD = "#e8641b", "#2f6fb0", "#f0b429", "#5b636e"
SHAPELESS = 0.2  # m, edge of the box that represents a payload without length
SPINNING = 40.0  # rad/s, drawn speed of the blades; at the true speed they would alias


class Aircraft(NamedTuple):
    """Meshes in body axes: the opaque parts (`solid`), and a translucent disc for each rotor (`blurs`).

    `hubs` (4 N, 3): the rotors' centres [m]; `spins` (4 N): ±1, of the reaction torque; `radii` (4 N) [m].
    """

    solid: Mesh
    blurs: list[Mesh]
    hubs: Array
    spins: Array
    radii: Array

    def blades(self, time: float) -> Mesh:
        """The mesh of all blades at a time [s]."""
        pairs = []
        for hub, spin, radius in zip(self.hubs, self.spins, self.radii, strict=True):
            angle = 0.7 - spin * SPINNING * time  # the reaction torque opposes the rotation
            c, s = np.cos(angle), np.sin(angle)
            R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            pairs.append(box(hub, [1.9 * radius, 0.16 * radius, 0.02 * radius], CARBON, R))
        return merged(pairs)

    @property
    def reach(self) -> float:
        """Largest distance of any part from the centre of mass [m]."""
        return float(np.linalg.norm(self.solid.corners, axis=2).max())


def aircraft(vehicle: Vehicle) -> Aircraft:
    """The meshes of a vehicle."""
    origin, solids = -vehicle.center_of_mass, [_payload(vehicle)]
    half = (vehicle.payload.length or 0.0) / 2.0
    for quadrotor, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        joint = origin + np.array(quadrotor.joint_position)
        nearest = origin + np.array([0.0, np.clip(quadrotor.joint_position[1], -half, half), 0.0])
        width = 0.09 * mean_arm(quadrotor)
        solids += [cylinder(nearest, joint, 0.8 * width, METAL), cylinder(joint, center, width, METAL)]
        solids += [_sensor(joint, center, vehicle.payload.radius or 0.0, 1.8 * width), _quadrotor(quadrotor, center)]
    hubs = np.concatenate([center + _hubs(q) for q, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)])
    radii = np.repeat([q.rotor_radius for q in vehicle.quadrotors], 4)
    spins = np.concatenate([q.spins for q in vehicle.quadrotors]).astype(float)
    ahead = np.concatenate([np.array(q.rotors)[:, 0] > 1e-9 for q in vehicle.quadrotors])
    blurs = [disc(h, r, FRONT if a else REAR) for h, r, a in zip(hubs, radii, ahead, strict=True)]
    return Aircraft(merged(solids), blurs, hubs, spins, radii)


def mean_arm(quadrotor: Quadrotor) -> float:
    """Mean distance of the rotors from the quadrotor's centre [m], a measure of its size."""
    return float(np.linalg.norm(quadrotor.rotors, axis=1).mean())


def _payload(vehicle: Vehicle) -> Mesh:
    """The payload: a beam with end caps, or a box if it has no length."""
    payload, origin = vehicle.payload, -vehicle.center_of_mass
    if not payload.length:
        return box(origin, [SHAPELESS] * 3, WOOD)
    radius, end = payload.radius or 0.03, np.array([0.0, payload.length / 2.0, 0.0])
    cap = np.array([0.0, 0.25 * radius, 0.0])
    return merged(
        [
            cylinder(origin - end, origin + end, radius, WOOD, sides=24),
            cylinder(origin - end - cap, origin - end + cap, 1.1 * radius, CARBON, sides=24),
            cylinder(origin + end - cap, origin + end + cap, 1.1 * radius, CARBON, sides=24),
        ]
    )


def _sensor(joint: Array, center: Array, depth: float, radius: float) -> Mesh:
    """The sensor at a joint: a collar where the strut leaves the payload, whose surface is `depth` above the joint."""
    way = center - joint
    length = max(float(np.linalg.norm(way)), 1e-9)
    start = min(depth, 0.8 * length)
    return cylinder(joint + way * start / length, joint + way * min(start + radius, length) / length, radius, JOINT)


def _hubs(quadrotor: Quadrotor) -> Array:
    """Centres (4, 3) of the rotor discs, relative to the quadrotor's centre of mass [m]."""
    return np.column_stack([quadrotor.rotors, np.full(4, 0.2 * mean_arm(quadrotor))])


def _quadrotor(quadrotor: Quadrotor, center: ArrayLike) -> Mesh:
    """Shell, arms, motors, guard ring and legs of one quadrotor."""
    size = mean_arm(quadrotor)
    parts = [_shell(size), torus([0.0, 0.0, 0.02 * size], quadrotor.guard_radius, 0.035 * size, GUARD)]
    for (x, y), hub in zip(quadrotor.rotors, _hubs(quadrotor), strict=True):
        color, outward = FRONT if x > 1e-9 else REAR, np.array([x, y, 0.0]) / max(np.hypot(x, y), 1e-9)
        parts.append(cylinder([0.0, 0.0, 0.0], outward * quadrotor.guard_radius, 0.05 * size, CARBON))
        parts.append(cylinder([x, y, -0.05 * size], [x, y, 0.12 * size], 0.1 * size, METAL))
        parts.append(
            cylinder([x, y, 0.12 * size], hub + np.array([0.0, 0.0, 0.04 * size]), 0.05 * size, color, 0.03 * size)
        )
    across, depth = quadrotor.feet_spread, quadrotor.feet_depth
    for corner in ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)):
        foot = np.array([across * corner[0], across * corner[1], -depth + 0.03 * size])
        parts.append(cylinder(foot * [0.55, 0.55, 0.0], foot, 0.03 * size, CARBON))
        parts.append(sphere(foot, 0.05 * size, CARBON))
    return merged(parts).placed(center, np.eye(3))


def _shell(size: float) -> Mesh:
    """The hull: a rounded body with a dark band, and a nose that points forward (along x)."""
    turn = np.linspace(-np.pi / 2.0, np.pi / 2.0, 15)
    profile = np.column_stack([0.42 * np.cos(turn) ** 0.5, 0.2 * np.sin(turn) + 0.03]) * size
    nose = cylinder([0.36 * size, 0.0, 0.03 * size], [0.5 * size, 0.0, 0.03 * size], 0.1 * size, CARBON, 0.06 * size)
    band = revolved(np.array([[0.43, -0.02], [0.43, 0.05]]) * size, CARBON, sides=32)
    return merged([revolved(profile, SHELL, smooth=True, sides=28), band, nose])
