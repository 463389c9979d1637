"""A mission's vehicle, floor and walls as MJCF text, from the numbers of the mission's tables alone.

One free body has its frame at the centre of mass, axes parallel to the payload's. Masses and inertias are summed here
by the parallel-axis theorem; the motion, and the forces of rotors, of damping and of contact, are MuJoCo's.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import mujoco
import numpy as np

GRAVITY = 9.81  # m/s2
LONGEST_STEP = 0.001  # s, of the judge's own time step
DEPTH = 100.0  # m, to which walls reach down
PAD = 0.01  # m, radius of a foot's pad
IMPEDANCE, FRICTION_IMPEDANCE = 0.01, 1e5  # of MuJoCo's contacts; of friction against the normal force
LEAST_SINKAGE = 2e-4  # m, which a step of 1 ms resolves
STIFF, DAMPED = 5000.0, 0.5  # N/m and damping ratio of walls and of parts that strike; chosen


class Body(NamedTuple):
    """The real vehicle: mass [kg], centre of mass from the payload's origin [m], inertia about it [kg m2].

    From that centre [m]: the payload's origin, and the quadrotors' places.
    """

    mass: float
    center: np.ndarray
    inertia: np.ndarray
    payload: np.ndarray
    quadrotors: np.ndarray


class Model(NamedTuple):
    """The compiled model, the real vehicle, how many of its steps make one of the mission's, and the floor's z [m].

    `arms` (N + 1, 3): origin of the payload and centres of quadrotors from the centre of mass [m].
    """

    mujoco: Any
    body: Body
    substeps: int
    floor: float | None
    arms: np.ndarray


def body_of(mission: dict[str, Any]) -> Body:
    """The real vehicle of a mission: the parts, then the factors of `plant`."""
    payload, fleet, plant = mission["vehicle"]["payload"], mission["vehicle"]["quadrotors"], mission["plant"]
    masses = np.array([payload["mass"], *(q["mass"] for q in fleet)])
    places = np.array([payload["center_of_mass"], *(q["position"] for q in fleet)])
    center = masses @ places / masses.sum()
    inertia = np.diag(moments_of_payload(payload))
    for (i, j), product in zip(((0, 1), (0, 2), (1, 2)), payload["products"], strict=True):
        inertia[i, j] = inertia[j, i] = product
    for q in fleet:
        inertia = inertia + turn_of(q) @ np.diag(q["inertia"]) @ turn_of(q).T
    for mass, d in zip(masses, places - center, strict=True):
        inertia = inertia + mass * (d @ d * np.eye(3) - np.outer(d, d))
    root = np.diag(np.sqrt(plant["inertia_scale"]))
    inertia = root @ inertia @ root
    return Body(float(masses.sum() * plant["mass_scale"]), center, inertia, -center, places[1:] - center)


def moments_of_payload(payload: dict[str, Any]) -> list[float]:
    """Principal moments [kg m2]: as given, or of a rod along y."""
    if payload.get("inertia") is not None:
        return list(payload["inertia"])
    mass, length, radius = payload["mass"], payload["length"], payload["radius"]
    return [mass * length**2 / 12.0, mass * radius**2 / 2.0, mass * length**2 / 12.0]


def rotors_of(q: dict[str, Any]) -> list[tuple[float, float]]:
    """The places of a quadrotor's rotors [m], from its centre."""
    if q.get("rotor_positions") is not None:
        own = q["rotor_positions"]
    else:
        start = 0.0 if q["layout"] == "+" else math.pi / 4.0
        angles = [start + i * math.pi / 2.0 for i in range(4)]
        own = [(q["arm"] * math.cos(a), q["arm"] * math.sin(a)) for a in angles]
    return [tuple(turn_of(q)[:2, :2] @ place) for place in own]


def turn_of(q: dict[str, Any]) -> np.ndarray:
    """The rotation of a quadrotor about body z, 3 x 3."""
    c, s = math.cos(q["heading"]), math.sin(q["heading"])
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def soles_of(mission: dict[str, Any], body: Body) -> np.ndarray:
    """The feet's soles from the centre of mass [m], 4 N x 3."""
    corners = [
        np.add(place, turn_of(q) @ [x * q["feet_spread"], y * q["feet_spread"], -q["feet_depth"]])
        for q, place in zip(mission["vehicle"]["quadrotors"], body.quadrotors, strict=True)
        for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]
    return np.array(corners)


def floor_height(mission: dict[str, Any], body: Body) -> float | None:
    """z of the floor [m]: as given, or such that the level vehicle stands at its start; None without a floor."""
    ground = mission["ground"]
    if ground["model"] == "none":
        return None
    if ground.get("height") is not None:
        return ground["height"]
    below = -soles_of(mission, body)[:, 2]
    share = ground["sinkage"] * len(below)  # N over the stiffness of one foot
    low, high = 0.0, below.max() + ground["sinkage"]
    for _ in range(80):  # the height at which the feet carry the weight
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.maximum(below - middle, 0.0).sum() > share else (low, middle)
    return float(mission["initial"]["position"][2] - 0.5 * (low + high))


def numbers(*values: Any) -> str:
    """Numbers as text with all digits."""
    return " ".join(repr(float(v)) for v in np.ravel(np.concatenate([np.atleast_1d(v) for v in values])))


def model_of(mission: dict[str, Any]) -> Model:
    """The model of a mission given as nested tables."""
    body, step = body_of(mission), mission["mission"]["step"]
    substeps = max(1, math.ceil(step / LONGEST_STEP - 1e-9))
    floor = floor_height(mission, body)
    text = _text(mission, body, step / substeps, floor)
    model = mujoco.MjModel.from_xml_string(text)
    moments, axes = np.linalg.eigh(body.inertia)
    axes[:, 2] *= np.linalg.det(axes)
    model.body_mass[1], model.body_inertia[1] = body.mass, moments  # which MuJoCo's compiler may refuse: A + B < C
    mujoco.mju_mat2Quat(model.body_iquat[1], axes.ravel())
    mujoco.mj_setConst(model, mujoco.MjData(model))
    drag = mission["vehicle"]["drag"]
    model.dof_damping[:] = [*drag["force"], *drag["moment"]]
    return Model(model, body, substeps, floor, np.vstack([body.payload, body.quadrotors]))


def _text(mission: dict[str, Any], body: Body, step: float, floor: float | None) -> str:
    walls = [*mission.get("walls", []), *corridor_walls(mission.get("corridor", {}))]
    shapes, rotors, actuators = [], [], []
    for i, (q, place) in enumerate(zip(mission["vehicle"]["quadrotors"], body.quadrotors, strict=True)):
        for j, ((x, y), spin) in enumerate(zip(rotors_of(q), q["spins"], strict=True)):
            rotors.append(f'<site name="r{i}.{j}" pos="{numbers(np.add(place, [x, y, 0.0]))}"/>')
            gear = numbers([0.0, 0.0, 1.0, 0.0, 0.0, q["torque_per_thrust"] * spin])
            actuators.append(f'<general site="r{i}.{j}" gear="{gear}"/>')
    if floor is not None:
        shapes += [*_feet(mission, body), *_hull(mission, body)]
    world = (
        []
        if floor is None
        else [f'<geom name="floor" type="plane" size="0 0 1" pos="0 0 {floor!r}" {_meets(FEET, HULL)}/>']
    )
    world += [_wall(wall) for wall in walls]
    return f"""<mujoco>
  <compiler inertiafromgeom="false" angle="radian"/>
  <option timestep="{step!r}" gravity="0 0 -{GRAVITY}" integrator="RK4" cone="elliptic" impratio="{FRICTION_IMPEDANCE}">
    <flag autoreset="disable"/>
  </option>
  <worldbody>{"".join(world)}
    <body name="vehicle" simple="false"><freejoint align="false"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>{"".join(rotors)}{"".join(shapes)}
    </body>
  </worldbody>
  <actuator>{"".join(actuators)}</actuator>
</mujoco>"""


FEET, HULL, SIDES = (
    1,
    2,
    4,
)  # bits of touching shapes: feet and floor; rotors, rings, beam and floor; spheres, beam and walls
THIN = 0.01  # m, half thickness of rotors and rings


def _meets(*bits: int) -> str:
    """Attributes of a shape that meets others with one of the same bits."""
    return f'contype="{sum(bits)}" conaffinity="{sum(bits)}"'


def _spring_damper(stiffness: float, damping: float, mass: float, friction: float) -> str:
    """Attributes of a contact that is a spring [N/m] and damper [N s/m] for a body of this mass.

    With a small impedance d, MuJoCo's constraint force is nearly that of a spring and damper (Computation: Parameters).
    """
    share = (1.0 - IMPEDANCE) / mass
    return (
        f'condim="{3 if friction else 1}" friction="{friction!r} 0 0" priority="1" '
        f'solimp="{IMPEDANCE} {IMPEDANCE} 0.001" solref="{numbers(-stiffness * share, -damping * share)}"'
    )


def _feet(mission: dict[str, Any], body: Body) -> list[str]:
    soles, ground = soles_of(mission, body), mission["ground"]
    sinkage, share = max(ground["sinkage"], LEAST_SINKAGE), body.mass / len(soles)
    attributes = _spring_damper(
        share * GRAVITY / sinkage, 2.0 * share * math.sqrt(GRAVITY / sinkage), body.mass, ground["friction"]
    )
    centers = np.add(soles, [0.0, 0.0, PAD])
    return [
        f'<geom name="foot{i}" type="sphere" size="{PAD}" pos="{numbers(center)}" {_meets(FEET)} {attributes}/>'
        for i, center in enumerate(centers)
    ]


def _hull(mission: dict[str, Any], body: Body) -> list[str]:
    """Rotors and the guards' rings as flat ellipsoids, guards as spheres, the beam as a capsule."""
    found, attributes = (
        [],
        _spring_damper(STIFF, 2.0 * DAMPED * math.sqrt(STIFF * body.mass), body.mass, mission["ground"]["friction"]),
    )

    def add(kind: str, place: np.ndarray, *size: float, meets: int) -> None:
        found.append(
            f'<geom type="{kind}" size="{numbers(size)}" pos="{numbers(place)}" {_meets(meets)} {attributes}/>'
        )

    for q, place in zip(mission["vehicle"]["quadrotors"], body.quadrotors, strict=True):
        guard, disc = q["guard_radius"], q["rotor_radius"]
        add("sphere", place, guard, meets=SIDES)
        add("ellipsoid", place, guard, guard, THIN, meets=HULL)
        for x, y in rotors_of(q):
            hub = np.add(place, [x, y, 0.0])
            add("ellipsoid", hub, disc, disc, THIN, meets=HULL)
            if math.hypot(x, y) + disc > guard:
                add("sphere", hub, disc, meets=SIDES)
    payload = mission["vehicle"]["payload"]
    if payload.get("length") is not None and payload.get("radius") is not None:
        half = np.array([0.0, payload["length"] / 2.0, 0.0])
        line, beam = numbers(body.payload - half, body.payload + half), numbers(payload["radius"])
        found.append(f'<geom type="capsule" size="{beam}" fromto="{line}" {_meets(HULL, SIDES)} {attributes}/>')
    return found


def _wall(wall: dict[str, Any]) -> str:
    (x1, y1), (x2, y2), top = wall["start"], wall["end"], wall["top"]
    half, turn = math.hypot(x2 - x1, y2 - y1) / 2.0, math.atan2(y2 - y1, x2 - x1)
    place = numbers([(x1 + x2) / 2.0, (y1 + y2) / 2.0, top - DEPTH / 2.0])
    size = numbers([half, 1e-4, DEPTH / 2.0])
    return f'<geom type="box" pos="{place}" size="{size}" euler="0 0 {turn!r}" {_meets(SIDES)}/>'


def corridor_walls(corridor: dict[str, Any]) -> list[dict[str, Any]]:
    """Walls at half the width on both sides of a centreline, which meet where neighbours' lines cross."""
    line = [np.array(p) for p in corridor.get("centreline", [])]
    if len(line) < 2:
        return []
    sides = []
    for side in (1.0, -1.0):
        corners = []
        for i, point in enumerate(line):
            legs = [line[j + 1] - line[j] for j in (i - 1, i) if 0 <= j < len(line) - 1]
            normals = [side * np.array([-leg[1], leg[0]]) / np.hypot(*leg) for leg in legs]
            offsets = np.full(len(normals), corridor["width"] / 2.0)  # n . (corner - point) on every leg beside it
            corners.append(point + np.linalg.lstsq(np.array(normals), offsets, rcond=None)[0])
        sides.append(corners)
    pairs = [(a, b) for corners in sides for a, b in pairwise(corners)]
    if corridor["ends"] == "closed":
        pairs += [(sides[0][0], sides[1][0]), (sides[0][-1], sides[1][-1])]
    return [{"start": a.tolist(), "end": b.tolist(), "top": corridor["height"]} for a, b in pairs]
