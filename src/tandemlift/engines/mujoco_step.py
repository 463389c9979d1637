"""Writes the step of a body in MuJoCo as machine code: around `mj_step`, with no Python in it.

Products of matrices are summed in the order of NumPy on processors with AVX, so that flights keep their bits. While no
shape can reach a floor within a step, the step is of a model without contact, which has the same bits too.
"""

from __future__ import annotations

from functools import lru_cache, partial
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.compiler.tracer import Function, Graph, Module, Place, double, symbols
from tandemlift.compiler.tracer.fused import once_rounded, rounded_twice
from tandemlift.core.algebra import sqrt
from tandemlift.core.vector import Absent, Vec3, set_of
from tandemlift.parts.contact.touches import PartContacts, SurfaceContacts, touches_after

# words: the function of a step, MuJoCo's functions, its memory, memory of ours, and two numbers
FUNCTIONS, STRUCTS = ("mj_step", "mj_contactForce"), ("model", "free", "data")
ARRAYS = ("qpos", "qvel", "ctrl", "applied", "on_quadrotors", "sensors")
CONTACTS, OWN = ("count", "geoms", "places"), ("constants", "spheres", "rows", "found")
POINTERS = ("advance", *FUNCTIONS, *STRUCTS, *ARRAYS, *CONTACTS, *OWN)
WORDS = (*POINTERS, "apart", "steps")
DIVERGED_FORCE = 1e8  # N, beyond which the flight has diverged; MuJoCo takes a command beyond 1e10 for zero
SLACK = 0.02  # m, that a shape moves in a step at most, beside twice what it moves at its speed
ROLLS = 5  # quadrotors from which on sets are loops


@lru_cache(maxsize=32)
def code_of(touches: Any, quadrotors: int, geoms: int, touching: bool) -> Code:
    """The code of `advance(words, thrusts, loads, push, moved, touches)`; see `registry.MachineBody`.

    Args:
        touches: a `parts.contact.touches.Touches`, or `Absent`.
        quadrotors: N.
        geoms: shapes in the model.
        touching: whether the model has contact.
    """
    key = key_of((touches,), "mujoco", quadrotors, geoms, touching)
    return Code(key, ["advance"], lambda: Written(_StepWriter(touches, quadrotors, geoms, touching).text, {}))


def rows_of(quadrotors: int) -> int:
    """Rows of the parts that may touch a surface: rotors, guards and the beam."""
    return 5 * quadrotors + 1


class _StepWriter:
    """Writes the step as LLVM text; arguments as of `code_of`."""

    def __init__(self, touches: Any, quadrotors: int, geoms: int, touching: bool) -> None:
        self.touches, self.N, self.geoms, self.rows = touches, quadrotors, geoms, rows_of(quadrotors)
        g, module = Graph(ROLLS if quadrotors >= ROLLS else 0), Module()
        pointers = ("%words", "%thrusts", "%loads", "%push", "%moved", "%touches")
        f = self.f = Function(module, g, 1, f"void @advance({', '.join(f'ptr {name}' for name in pointers)}) #0")
        self.word = {n: f.load("%words", i, "ptr" if n in POINTERS else "i64") for i, n in enumerate(WORDS)}
        places = {**self.word, "thrust": "%thrusts", "load": "%loads", "push": "%push", "touch": "%touches"}
        self.room = places["room"] = f.own_memory(6)
        f.read = {name: partial(Place, base) for name, base in places.items()}
        f.read["t"] = lambda _: self.t
        self.numbers = self._inputs("constants", 4), self._inputs("constants", 6, 4), self._inputs("constants", 9, 10)
        self.thrusts = [self._inputs("thrust", 4, 4 * i) for i in range(quadrotors)]
        square = sum(x * x for own in self.thrusts for x in own)
        sound = f.value(square < DIVERGED_FORCE * DIVERGED_FORCE)
        with f.when(sound):
            self._set_loads(square)
            self._step(touching)
            with f.afresh():
                self._read(touching)
                if not isinstance(touches, Absent):
                    self._log_contacts()
        with f.when(f.op(f"xor i1 {sound}, true")), f.repeat(19 + 6 * quadrotors) as i:
            f.store(double(np.nan), "%moved", i)
        f.end()
        self.text = module.text

    def _inputs(self, kind: str, count: int, first: int = 0) -> list[Any]:
        return [self.f.graph.input(kind, i) for i in range(first, first + count)]

    def _set_loads(self, square: Any) -> None:
        """Apply thrusts, disturbance, push, and loads: to the payload about the centre of mass, to each quadrotor."""
        f, N, (_, disturbance, place) = self.f, self.N, self.numbers
        f.put(self.word["ctrl"], 0, [x for own in self.thrusts for x in own])
        applied = [a + b for a, b in zip(self._inputs("push", 6), disturbance, strict=True)]
        f.put(self.word["applied"], 0, applied)
        f.put(self.room, 0, [sum((x * x for x in applied), square)])
        with f.when(f.op("icmp ne ptr %loads, null")):
            loads, R = self._inputs("load", 6 * N + 6), _rotation(*self._inputs("qpos", 4, 3))
            force = [_dot(loads[:3], R[i::3]) for i in range(3)]  # in body axes
            moment = [_dot(place[3 * i : 3 * i + 3], force, 1) for i in range(3)]
            applied = [a + b for a, b in zip(applied, loads[:6], strict=True)]
            applied[3:] = [a + b for a, b in zip(applied[3:], moment, strict=True)]
            f.put(self.word["applied"], 0, applied)
            for i in range(N):
                own = loads[6 + i :: N]
                turned = [_dot(R[3 * j : 3 * j + 3], own[3:], int(N == 1)) for j in range(3)]
                f.put(self.word["on_quadrotors"], 6 * i, [*own[:3], *turned])
            f.put(self.room, 0, [sum((x * x for x in [*applied, *loads]), square)])

    def _step(self, touching: bool) -> None:
        """Let MuJoCo take the step: without contact where no shape can reach the floor."""
        f, model = self.f, self.word["model"]
        if touching:
            (dt, floor, reach, calm), _, _ = self.numbers
            (height, a, x, y, z), (squares,) = self._inputs("qpos", 5, 2), self._inputs("room", 1)
            vx, vy, vz, p, q, r = self._inputs("qvel", 6)
            up = 2.0 * (x * z - a * y), 2.0 * (y * z + a * x), 1.0 - 2.0 * (x * x + y * y)
            moves = SLACK + 2.0 * dt * (sqrt(vx * vx + vy * vy + vz * vz) + reach * sqrt(p * p + q * q + r * r))
            quiet, least, *ups = f.values([squares < calm, floor - height + moves, *symbols(f.graph, up)])
            f.store(double(np.inf), self.room)
            with f.repeat(2 * self.geoms) as i:
                sphere = f.at(self.word["spheres"], f.integer("mul", i, 4))
                lowest = f.op(f"fneg double {f.load(sphere, 3)}")
                for j, up_j in enumerate(ups):
                    lowest = f.op(f"fadd double {lowest}, {f.op(f'fmul double {up_j}, {f.load(sphere, j)}')}")
                with f.when(f.op(f"fcmp ult double {lowest}, {f.load(self.room)}")):
                    f.store(lowest, self.room)
            above = f.op(f"and i1 {quiet}, {f.op(f'fcmp ogt double {f.load(self.room)}, {least}')}")
            model = f.op(f"select i1 {above}, ptr {self.word['free']}, ptr {model}")
        f.do(f"call void {self.word['mj_step']}(ptr {model}, ptr {self.word['data']})")

    def _read(self, touching: bool) -> None:
        """Read state and sensors; a joint's sensor reads the load on the quadrotor, without that of its rotors."""
        f, N = self.f, self.N
        q, v, sensors = self._inputs("qpos", 7), self._inputs("qvel", 6), self._inputs("sensors", 6 * N + 3)
        moments = [[self._inputs("constants", 4, 19 + 4 * (a * N + i)) for i in range(N)] for a in range(3)]
        made = [[_rotors(t, m) for t, m in zip(self.thrusts, own, strict=True)] for own in moments]
        made = [[0.0] * N, [0.0] * N, [_rotors(t, [1.0] * 4) for t in self.thrusts], *made]
        felt = [made[a][i] - sensors[3 + (a // 3 * N + i) * 3 + a % 3] for a in range(6) for i in range(N)]
        contact = self._inputs("sensors", 3 * touching, 6 * N + 3)
        f.put("%moved", 0, [*q[:3], *v[:3], *q[3:], *v[3:], *sensors[:3], *felt, *contact])

    def _log_contacts(self) -> None:
        """Enter the contacts at the end of the step, but those of feet, into the record: see `touches.ContactLog`."""
        f, word, rows, found = self.f, self.word, 2 * self.rows, self.word["found"]
        steps, dt = f.integer("add", word["steps"], 1), f.value(self.numbers[0][0])
        f.store(steps, "%words", WORDS.index("steps"), "i64")
        self.t = f.op(f"fmul double {f.op(f'sitofp i64 {steps} to double')}, {dt}")
        count = f.op(f"sext i32 {f.load(word['count'], 0, 'i32')} to i64")
        with f.when(f.op(f"icmp ne i64 {count}, 0")):
            with f.repeat(5 * rows + 1) as i:
                f.store("0.0", found, i)
            with f.repeat(count) as i:
                geom, place = (f.at(word[name], f.integer("mul", i, word["apart"]), "i8") for name in CONTACTS[1:])
                one, other = (f.op(f"zext i32 {f.load(geom, j, 'i32')} to i64") for j in (0, 1))
                row = f.load(word["rows"], f.integer("add", f.integer("mul", one, self.geoms), other), "i64")
                with f.when(f.op(f"icmp sge i64 {row}, 0")):
                    given = *(f"ptr {word[name]}" for name in ("model", "data")), f"i32 {f.op(f'trunc i64 {i} to i32')}"
                    f.do(f"call void {word['mj_contactForce']}({', '.join(given)}, ptr {self.room})")
                    with f.when(f.op(f"fcmp ogt double {f.load(self.room)}, 0.0")):
                        self._add(row, f.load(self.room), place)
            with f.when(f.op(f"fcmp une double {f.load(found, 5 * rows)}, 0.0")):
                before, (dt,) = f.graph.inputs("touch", self.touches), self._inputs("constants", 1)
                surfaces = self._surface(self.touches.floor, 0), self._surface(self.touches.walls, self.rows)
                after = rounded_twice(touches_after)(before, *surfaces, f.graph.input("t"), dt)
                f.put("%touches", 0, symbols(f.graph, after), "touch")

    def _add(self, row: str, normal: str, place: str) -> None:
        """Add a contact to what is found: sums of normal forces, places of the hardest, and these forces."""
        f, found, rows = self.f, self.word["found"], 2 * self.rows
        f.store("1.0", found, 5 * rows)
        f.store(f.op(f"fadd double {f.load(found, row)}, {normal}"), found, row)
        hardest = f.integer("add", row, 4 * rows)
        with f.when(f.op(f"fcmp ogt double {normal}, {f.load(found, hardest)}")):
            f.store(normal, found, hardest)
            for j in range(3):
                f.store(f.load(place, j), found, f.integer("add", row, (j + 1) * rows))

    def _surface(self, records: Any, first: int) -> Any:
        """The contacts with a surface from its first row on; each `Absent` where its record is."""
        if isinstance(records, Absent):
            return records
        parts = list[Any]()
        for count, record in zip((4 * self.N, self.N, 1), records, strict=True):
            like, rows = set_of([0.0] * count), 2 * self.rows
            normal, *place = (self.f.graph.inputs("found", like, first + j * rows) for j in range(4))
            parts.append(record if isinstance(record, Absent) else PartContacts(normal, Vec3(*place)))
            first += count
        return SurfaceContacts(*parts)


def _rotation(w: Any, x: Any, y: Any, z: Any) -> list[Any]:
    """The rotation matrix of a quaternion, row by row, rounded as by MuJoCo's `mju_quat2Mat`."""
    ww, xx, yy, zz = w * w, x * x, y * y, z * z
    wx, wy, wz, xy, xz, yz = w * x, w * y, w * z, x * y, x * z, y * z
    first = [(ww - yy) + (xx - zz), 2.0 * (xy - wz), 2.0 * (xz + wy)]
    second = [2.0 * (xy + wz), (ww + yy) - (xx + zz), 2.0 * (yz - wx)]
    return [*first, *second, 2.0 * (xz - wy), 2.0 * (yz + wx), (ww - yy) + (zz - xx)]


def _dot(a: Any, b: Any, first: int = 0) -> Any:
    """The product of two vectors: that of one number `first`, then the others in order, each rounded once."""
    one, two, three = [first, *[i for i in range(3) if i != first]]
    return once_rounded(a[three], b[three], once_rounded(a[two], b[two], a[one] * b[one]))


def _rotors(thrusts: Any, factors: Any) -> Any:
    """The sum over four rotors, in pairs; it begins at 0, which it then never turns into −0."""
    one, two, three, four = (once_rounded(a, b, 0.0) for a, b in zip(factors, thrusts, strict=True))
    return (one + three) + (two + four)
