"""Sets of many numbers: what a loop over them makes is, to the last bit, what the same law written out makes."""

from typing import Any, NamedTuple

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.machine_code.machine import BEST, QUICK
from tandemlift.core.algebra import absolute, clip, exp, greatest, maximum, sqrt, tanh, where
from tandemlift.core.caching import LastUsed
from tandemlift.core.law import elementwise, law
from tandemlift.core.vector import Vec3, cross, dot, each, quarters, set_of, total
from tandemlift.simulation.preparation import traced_step

ROWS = 13


class Mixed(NamedTuple):
    """Sets among numbers, as a flight has them."""

    number: Any
    sets: Any
    vector: Vec3


@elementwise
def bent(x, y, k):
    return where(absolute(x) > 0.5, tanh(x * k) + y, sqrt(absolute(y) + 1.0) * x - k)


@elementwise
def picked(x, most, a, b):
    return where(x > most * 0.5, a, clip(b, -1.0, 1.0))


@law
def law_of_sets(m: Mixed, k: Any) -> Any:
    """Numbers made of sets and sets made of numbers, in turns; parts of sets; choices; vectors of sets."""
    a, b = m.sets, m.vector
    c = bent(a, b.x, k) * total(a) + b.y
    turned = cross(b, Vec3(c, a, c * 2.0))
    d = picked(c, greatest(c), turned.x, turned.y)
    q = quarters(d)
    e = q.first * q.third + q.second - q.fourth / maximum(absolute(q.first), 0.1)
    back = set_of([x for pair in zip(e, e, e, e, strict=True) for x in pair])
    f = exp(-absolute(d)) + back * dot(a, c)
    return m.number + total(e), Vec3(f, turned.z, f[::-1] if hasattr(f, "rolled") else set_of(f[::-1])), d


@pytest.mark.parametrize(("count", "lanes"), [(4, 1), (20, 8), (36, 1)])
def test_a_loop_over_a_set_gives_the_bits_of_the_law_written_out(count, lanes):
    one = each(count)(*[0.0] * count)
    like = Mixed(0.0, one, Vec3(one, one, one))
    rows = np.random.default_rng(count).standard_normal((ROWS, 2 + 4 * count))
    written_out = compiled(law_of_sets, like, 0.0, lanes=lanes, level=QUICK)(rows)
    for level in (QUICK, BEST):
        rolled = compiled(law_of_sets, like, 0.0, lanes=lanes, level=level, rolls_from=2)(rows)
        assert np.array_equal(rolled, written_out)
    python = [law_of_sets(Mixed(r[0], each(count)(*r[1 : 1 + count]), vectors(r, count)), r[-1]) for r in rows[:3]]
    assert rolled[:3] == pytest.approx(np.array([numbers(found) for found in python]), rel=1e-9, abs=1e-9)


def vectors(row, count):
    return Vec3(*[each(count)(*part) for part in np.split(row[1 + count : -1], 3)])


def numbers(value):
    return [x for part in value for x in numbers(part)] if isinstance(value, tuple) else [float(value)]


def test_a_set_copied_onto_itself_the_other_way_round_is_whole():
    """Memory that is read and written: everything is computed before anything is written."""
    one = each(12)(*[0.0] * 12)

    @law
    def swapped(a, b):
        return b, a[::-1] if hasattr(a, "rolled") else set_of(a[::-1])

    rows = np.random.default_rng(1).standard_normal((4, 24))
    found = compiled(swapped, one, one, rolls_from=2)(rows)
    assert np.array_equal(found, np.hstack([rows[:, 12:], rows[:, 11::-1]]))


def quadrotors(mission, count):
    """So many quadrotors along the beam."""
    one = tl.load_mission(mission).vehicle.quadrotors[0].model_dump(mode="json")
    reach = max(1.0, 0.4 * (count - 1))  # m, so that no rotor strikes another
    return [{**one, "position": [0.0, float(y), 0.075]} for y in np.linspace(reach, -reach, count)]


def fleet(mission, count, **changes):
    """Eight different flights of a vehicle of so many quadrotors."""
    changes = {"vehicle.quadrotors": quadrotors(mission, count), **changes}
    return [
        tl.load_mission(mission, {**changes, "mission.seed": i, "plant.mass_scale": 1.0 + 0.003 * i}) for i in range(8)
    ]


def same(a, b):
    return all(np.array_equal(a[name], b[name]) for name in a)


# Each compiles two loops for seconds: these have, together, every part that is mapped over quadrotors.
@pytest.mark.thorough
@pytest.mark.parametrize(("mission", "count"), [("iris", 8), ("gusts", 6), ("zigzag", 5)])
def test_many_quadrotors_fly_alike_in_loops_and_written_out(mission, count, monkeypatch, tmp_path):
    missions = fleet(mission, count, **{"mission.duration": 4.0})
    together, alone = tl.fly_many(missions), [tl.fly(missions[i]) for i in (0, 7)]
    assert same(alone[0], together[0])
    assert same(alone[1], together[7])
    monkeypatch.setattr(traced_step, "MANY", 1000)
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path))
    monkeypatch.setattr("tandemlift.simulation.plan.LOOP_CODE", LastUsed(8))
    assert same(tl.fly(missions[7]), together[7])


@pytest.mark.thorough
def test_sixty_four_quadrotors_fly_alone_and_in_a_block():
    missions = fleet("paper", 64, **{"mission.duration": 0.3})
    together = tl.fly_many(missions)
    assert same(tl.fly(missions[3]), together[3])
    assert together[3]["rotor_thrusts"].shape[1] == 256
