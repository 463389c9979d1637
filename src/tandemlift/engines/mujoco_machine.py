"""The step of a body in MuJoCo as machine code, which calls MuJoCo's own C functions: no Python runs in it.

Its numbers are those of `mujoco.MuJoCoBody.advance` in Python, to the bit: products of matrices are summed in NumPy's
order. While no part of the vehicle can reach the floor within a step, the step is of a model without contact.
"""

from __future__ import annotations

import ctypes
from copy import copy
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.compiler.tracer import Function, Graph, Module, Place, double, symbols
from tandemlift.compiler.tracer.fused import once_rounded, rounded_twice
from tandemlift.core.algebra import sqrt
from tandemlift.core.types import Array
from tandemlift.core.vector import Absent, Vec3, set_of
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.parts.contact.touches import PartContacts, SurfaceContacts, touches_after

FUNCTIONS = ("mj_step", "mj_contactForce", "mju_quat2Mat")
MEMORY = ("qpos", "qvel", "ctrl", "applied", "on_quadrotors", "sensors", "places", "shapes")  # of MuJoCo
POINTERS = (*("advance", "numbers"), *FUNCTIONS, *("model", "free", "data"), *MEMORY, *("count", "k", "rows", "found"))
WORDS = (*POINTERS, "apart", "steps")
UNSOUND = 1e8  # N, beyond which the flight has diverged; MuJoCo takes a command beyond 1e10 for zero
SLACK = 0.02  # m, that a part moves in a step at most, beside twice what it moves at its speed
ROLLS = 5  # quadrotors from which on sets are loops


def python_is_needed(model: Any) -> bool:
    """Whether a step needs Python: MuJoCo calls functions of the user, or its package has no addresses."""
    called = [name for name in dir(mujoco) if name.startswith(("get_mjcb_", "get_mju_user_"))]
    return not hasattr(model, "_address") or any(getattr(mujoco, name)() is not None for name in called)


class MachineStep:
    """The step of a body in MuJoCo; see `registry.MachineBody`.

    Args:
        model: the `mujoco.MjModel`.
        data: the `mujoco.MjData`; it has no contact yet.
        numbers: state, readings and touches of the body, which a step writes.
        touches: a `parts.contact.touches.Touches`, or `Absent`.
        parts: the row of each pair of shapes whose contact is a touch, of rotors, guards and beam on floor and walls.
        constants: disturbance (6), matrix of the payload's place × (9), moments of rotors at the joints (12 N).
        step: [s].

    Attributes:
        address: of its words.

    Raises:
        AttributeError, ValueError: MuJoCo has no such function or memory.
    """

    def __init__(
        self,
        model: Any,
        data: Any,
        numbers: Array,
        touches: Any,
        parts: dict[tuple[int, int], int],
        constants: Array,
        step: float,
    ) -> None:
        N, free, spheres = model.nu // 4, copy(model), spheres_above_floor(model)
        free.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
        library = ctypes.CDLL(mujoco._functions.__file__)
        functions = [ctypes.cast(getattr(library, name), ctypes.c_void_p).value for name in FUNCTIONS]
        count, places, shapes = contact_memory(data)
        memory = [data.qpos, data.qvel, data.ctrl, data.qfrc_applied, data.xfrc_applied[2:], data.sensordata]
        rows = np.full((model.ngeom, model.ngeom), -1)
        for (one, other), row in parts.items():
            rows[one, other] = rows[other, one] = row
        own = [np.concatenate([constants, [step], spheres]), rows, np.zeros(5 * rows_of(N))]
        layout = N, model.ngeom, int(model.npair > 0), max(len(spheres) - 3, 0) // 4
        key = key_of((touches,), "mujoco", *layout)
        self._code = Code(key, ["advance"], lambda: Written(BodyStepWriter(touches, *layout).text, {}))
        advance = ctypes.cast(self._code.free["advance"], ctypes.c_void_p).value
        assert advance is not None
        self._call = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(advance)
        arrays = [x.ctypes.data for x in (*memory, places, shapes)]
        first = [advance, numbers.ctypes.data, *functions, model._address, free._address, data._address, *arrays, count]
        self._words = np.array([*first, *[x.ctypes.data for x in own], places.strides[0], 0])
        self.address, self._kept = int(self._words.ctypes.data), (model, data, free, numbers, own)

    def advance(self, thrusts: Array, loads: Array, push: Array) -> None:
        """Take a step from Python; inputs as of `registry.EngineBody.advance`, force and moment in one array."""
        given = [np.ascontiguousarray(x) for x in (thrusts, loads, push)]
        self._call(self.address, *[x.ctypes.data if x.size else None for x in given])


def rows_of(quadrotors: int) -> int:
    """Parts that may touch floor and walls: rotors, guards and the beam, on each."""
    return 2 * (5 * quadrotors + 1)


def contact_memory(data: Any) -> tuple[int, Array, Array]:
    """The address of the number of contacts, and the places and shapes of contacts, of which there is none yet."""
    size = (data.energy.ctypes.data - data._address) // 4  # the energy stands behind that number
    words = np.ctypeslib.as_array((ctypes.c_int32 * size).from_address(data._address))
    before, data.ncon = words.copy(), 1
    (at,) = np.flatnonzero(words != before)
    places, shapes = data.contact.pos, data.contact.geom
    data.ncon = 0
    return int(words[at:].ctypes.data), places, shapes


def spheres_above_floor(model: Any) -> Array:
    """What tells that no shape reaches the floor in a step; empty where shapes meet anything else, or nothing.

    Returns:
        The highest floor [m]; the greatest distance of a shape from the centre of mass [m]; the greatest sum of squares
        of all forces [N] and moments [N m] under which no shape moves by half of `SLACK`; then x, y, z [m, body axes]
        and radius [m] of spheres around the shapes.
    """
    kinds, pairs = mujoco.mjtGeom, np.array([model.pair_geom1, model.pair_geom2])
    planes = model.geom_type[pairs] == kinds.mjGEOM_PLANE
    if not model.npair or not planes.any(axis=0).all():
        return np.zeros(0)
    data = mujoco.MjData(model)
    data.qpos[:] = np.eye(7)[3]
    mujoco.mj_kinematics(model, data)
    shapes = np.unique(pairs[~planes])
    capsules, size = model.geom_type[shapes] == kinds.mjGEOM_CAPSULE, model.geom_size[shapes]
    half = data.geom_xmat[shapes, 2::3] * np.where(capsules, size[:, 1], 0.0)[:, None]
    radius = np.where(capsules, size[:, 0], model.geom_rbound[shapes])
    spheres = np.unique([np.c_[data.geom_xpos[shapes] + end, radius] for end in (half, -half)], axis=1).reshape(-1, 4)
    reach = (np.linalg.norm(spheres[:, :3], axis=1) + radius.max()).max()
    gain = model.dof_invweight0[0] + 3.0 * model.dof_invweight0[5] * reach * max(reach, 1.0)  # m/s² for 1 N
    calm = (SLACK / (model.opt.timestep**2 * gain)) ** 2 / (12 + 10 * (model.nu // 4))
    return np.array([model.geom_pos[np.unique(pairs[planes]), 2].max(), reach, calm, *spheres.ravel()])


class BodyStepWriter:
    """Writes the step as LLVM text.

    Args:
        touches: a `Touches`, or `Absent`.
        quadrotors: N.
        shapes: in the model.
        touching: 1 where the model has contact, else 0.
        spheres: that tell whether the vehicle is above the floor; 0 if nothing does.
    """

    def __init__(self, touches: Any, quadrotors: int, shapes: int, touching: int, spheres: int) -> None:
        self.touches, self.N, self.shapes, self.spheres = touches, quadrotors, shapes, spheres
        self.joints, self.size = 6 * quadrotors, 19 + 6 * quadrotors  # numbers of state and readings
        module, g = Module(), Graph(ROLLS if quadrotors >= ROLLS else 0)
        f = self.f = Function(module, g, 1, "void @advance(ptr %c, ptr %thrusts, ptr %loads, ptr %push) #0")
        self.word = {name: f.load("%c", i, "ptr" if name in POINTERS else "i64") for i, name in enumerate(WORDS)}
        places = {"thrust": "%thrusts", "load": "%loads", "push": "%push", "k": self.word["k"]}
        places |= {"q": self.word["qpos"], "v": self.word["qvel"], "found": self.word["found"]}
        self.turn, self.room = f.own_memory(9), f.own_memory(6)
        places |= {"R": self.turn, "sum": self.room, "sensor": self.word["sensors"], "state": self.word["numbers"]}
        f.read = {name: (lambda i, base=base: Place(base, i)) for name, base in places.items()}
        square = sum(x * x for x in self.inputs("thrust", 4 * self.N))
        sound = f.value(square < UNSOUND * UNSOUND)
        with f.when(sound):
            self._set_loads()
            self._step(square)
            self._read(touching)
            if touching and not isinstance(touches, Absent):
                self._log_contacts()
        with f.when(f.op(f"xor i1 {sound}, true")), f.repeat(self.size) as i:
            f.store(double(np.nan), self.word["numbers"], i)
        f.end()
        self.text = module.text

    def inputs(self, kind: str, count: int, first: int = 0) -> list[Any]:
        return [self.f.graph.input(kind, i) for i in range(first, first + count)]

    def _set_loads(self) -> None:
        """Apply thrusts, disturbance, push, and the loads on the parts: see `MuJoCoBody._load`."""
        f, N, (force, moment) = self.f, self.N, (slice(3), slice(3, 6))
        f.put(self.word["ctrl"], 0, self.inputs("thrust", 4 * N))
        applied = [a + b for a, b in zip(self.inputs("push", 6), self.inputs("k", 6), strict=True)]
        f.put(self.word["applied"], 0, applied)
        f.put(self.room, 0, [sum(x * x for x in applied)])
        with f.when(f.op("icmp ne ptr %loads, null")):
            f.do(f"call void {self.word['mju_quat2Mat']}(ptr {self.turn}, ptr {f.at(self.word['qpos'], 3)})")
            loads, R, place = self.inputs("load", 6 * N + 6), self.inputs("R", 9), self.inputs("k", 9, 6)
            applied = [a + b for a, b in zip(applied, loads[:6], strict=True)]
            turned = [_dot(loads[force], R[i::3]) for i in range(3)]
            applied[moment] = [m + _dot(place[3 * i : 3 * i + 3], turned, 1) for i, m in enumerate(applied[moment])]
            f.put(self.word["applied"], 0, applied)
            columns = [loads[6 + i :: N] for i in range(N)]  # of a quadrotor: force, then moment
            for i, own in enumerate(columns):
                turned = [_dot(R[3 * j : 3 * j + 3], own[moment], int(N == 1)) for j in range(3)]
                f.put(self.word["on_quadrotors"], 6 * i, [*own[force], *turned])
            f.put(self.room, 0, [sum(x * x for x in [*applied, *loads])])

    def _step(self, square: Any) -> None:
        """Let MuJoCo take the step: without contact while every shape stays above the floor."""
        f, model = self.f, self.word["model"]
        if self.spheres:
            at = 16 + 12 * self.N  # behind the length of a step
            dt, floor, reach, calm = self.inputs("k", 4, at - 1)
            (w, x, y, z), (vx, vy, vz, p, q, r) = self.inputs("q", 4, 3), self.inputs("v", 6)
            up = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
            moves = SLACK + 2.0 * dt * (sqrt(vx * vx + vy * vy + vz * vz) + reach * sqrt(p * p + q * q + r * r))
            above = f.value(self.inputs("q", 1, 2)[0] - floor - moves)
            ups = f.values(symbols(f.graph, up))
            f.store(double(np.inf), self.turn)
            with f.repeat(self.spheres) as i:
                sphere = f.at(self.word["k"], f.integer("add", f.integer("mul", i, 4), at + 3))
                height = f.op(f"fneg double {f.load(sphere, 3)}")
                for j, up_j in enumerate(ups):
                    height = f.op(f"fadd double {height}, {f.op(f'fmul double {up_j}, {f.load(sphere, j)}')}")
                lower = f.op(f"fcmp olt double {height}, {f.load(self.turn)}")
                with f.when(lower):
                    f.store(height, self.turn)
            clear = f.op(f"fcmp ogt double {f.op(f'fadd double {above}, {f.load(self.turn)}')}, 0.0")
            quiet = f.value(square + self.inputs("sum", 1)[0] < calm)
            model = f.op(f"select i1 {f.op(f'and i1 {clear}, {quiet}')}, ptr {self.word['free']}, ptr {model}")
        f.do(f"call void {self.word['mj_step']}(ptr {model}, ptr {self.word['data']})")

    def _read(self, touching: int) -> None:
        """Copy state and sensors; a joint's sensor reads the load on the quadrotor, without that of its rotors."""
        f, N, numbers = self.f, self.N, self.word["numbers"]
        with f.afresh():
            q, v, sensors = self.inputs("q", 7), self.inputs("v", 6), self.inputs("sensor", self.joints + 3)
            f.put(numbers, 0, [*q[:3], *v[:3], *q[3:], *v[3:], *sensors[:3]])
            made = [[0.0] * N, [0.0] * N, [_rotors(self.inputs("thrust", 4, 4 * i)) for i in range(N)]]
            for axis in range(3):
                moments = [self.inputs("k", 4, 15 + 4 * (axis * N + i)) for i in range(N)]
                thrusts = [self.inputs("thrust", 4, 4 * i) for i in range(N)]
                made.append([_rotors(t, m) for t, m in zip(thrusts, moments, strict=True)])
            felt = [made[a][i] - sensors[3 + (a // 3 * N + i) * 3 + a % 3] for a in range(6) for i in range(N)]
            f.put(numbers, 16, felt)
            if touching:
                f.put(numbers, 16 + self.joints, self.inputs("sensor", 3, 3 + self.joints))

    def _log_contacts(self) -> None:
        """Enter the contacts at the end of the step, but those of feet, into the record: see `touches.ContactLog`."""
        f, word, rows = self.f, self.word, rows_of(self.N)
        found, (_, _, _, hardest) = word["found"], (rows, 2 * rows, 3 * rows, 4 * rows)
        steps = f.integer("add", word["steps"], 1)
        f.store(steps, "%c", WORDS.index("steps"), "i64")
        count = f.op(f"sext i32 {f.load(word['count'], 0, 'i32')} to i64")
        with f.when(f.op(f"icmp ne i64 {count}, 0")):
            with f.repeat(5 * rows) as i:
                f.store("0.0", found, i)
            f.store("0.0", self.turn)
            with f.repeat(count) as i:
                at = f.integer("mul", i, word["apart"])
                shapes, place = (f.at(word[name], at, "i8") for name in ("shapes", "places"))
                one, other = (f.op(f"zext i32 {f.load(shapes, j, 'i32')} to i64") for j in (0, 1))
                row = f.load(word["rows"], f.integer("add", f.integer("mul", one, self.shapes), other), "i64")
                with f.when(f.op(f"icmp sge i64 {row}, 0")):
                    number = f.op(f"trunc i64 {i} to i32")
                    given = f"ptr {word['model']}, ptr {word['data']}, i32 {number}, ptr {self.room}"
                    f.do(f"call void {word['mj_contactForce']}({given})")
                    normal = f.load(self.room)
                    with f.when(f.op(f"fcmp ogt double {normal}, 0.0")):
                        f.store("1.0", self.turn)
                        f.store(f.op(f"fadd double {f.load(found, row)}, {normal}"), found, row)
                        greatest = f.integer("add", row, hardest)
                        with f.when(f.op(f"fcmp ogt double {normal}, {f.load(found, greatest)}")):
                            f.store(normal, found, greatest)
                            for j in range(3):
                                f.store(f.load(place, j), found, f.integer("add", row, (j + 1) * rows))
            with f.when(f.op(f"fcmp une double {f.load(self.turn)}, 0.0")), f.afresh():
                t = f.op(f"fmul double {f.op(f'sitofp i64 {steps} to double')}, {f.load(word['k'], 15 + 12 * self.N)}")
                f.read["t"] = lambda _: t
                before, dt = f.graph.inputs("state", self.touches, self.size), f.graph.input("k", 15 + 12 * self.N)
                floor, walls = self._surface(self.touches.floor, 0), self._surface(self.touches.walls, rows // 2)
                after = rounded_twice(touches_after)(before, floor, walls, f.graph.input("t"), dt)
                f.put(word["numbers"], self.size, symbols(f.graph, after), "state")

    def _surface(self, records: Any, first: int) -> Any:
        """The contacts with a surface whose first row is given; each `Absent` where the record is."""
        if isinstance(records, Absent):
            return records
        parts, rows = list[Any](), rows_of(self.N)
        for count, record in zip((4 * self.N, self.N, 1), records, strict=True):
            like = set_of([0.0] * count)
            columns = [self.f.graph.inputs("found", like, first + j * rows) for j in range(4)]
            parts.append(record if isinstance(record, Absent) else PartContacts(columns[0], Vec3(*columns[1:])))
            first += count
        return SurfaceContacts(*parts)


def _dot(a: Any, b: Any, first: int = 0) -> Any:
    """The product of vectors as NumPy sums it: one number `first`, then the others in order, fused."""
    order = [first, *[i for i in range(3) if i != first]]
    total = a[order[0]] * b[order[0]]
    for i in order[1:]:
        total = once_rounded(a[i], b[i], total)
    return total


def _rotors(thrusts: Any, factors: Any = (1.0,) * 4) -> Any:
    """The sum over four rotors as NumPy forms it in lanes; it begins at 0, which is then never −0."""
    one, two, three, four = (once_rounded(a, b, 0.0) for a, b in zip(factors, thrusts, strict=True))
    return (one + three) + (two + four)
