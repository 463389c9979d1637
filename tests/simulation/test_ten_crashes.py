"""Ten crashes in two engines that share no contact law: the same outcome, and the same part touches first."""

from __future__ import annotations

import math

import pytest
from ten_crashes import CRASHES, crash_mission, crashed_in

pytest.importorskip("mujoco")

SOON, CLOSE = 0.02, 0.05  # s, m: of the first touch
UNTOUCHED = ["fallen from 2 m at a stop"]  # it lands on its feet


@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_ends_alike_in_mujoco_and_the_same_part_touches_first(name):
    ours, theirs = (crashed_in(engine, crash_mission(name)) for engine in ("compiled", "mujoco"))
    assert ours.flight.outcome == theirs.flight.outcome == "crashed"
    if name in UNTOUCHED:
        assert ours.touches == theirs.touches == []
        return
    first, other = ours.touches[0], theirs.touches[0]
    assert (first.part, first.surface) == (other.part, other.surface)
    assert first.time == pytest.approx(other.time, abs=SOON)
    assert math.dist(first.place, other.place) < CLOSE
    assert first.force == pytest.approx(other.force, rel=0.5)
    print(f"{name}: rests at {ours.rests}, in MuJoCo at {theirs.rests}")


def test_the_crashes_touch_with_every_kind_of_part_on_floor_and_walls():
    found = {
        (t.part.split()[0], t.surface) for name in CRASHES for t in crashed_in("compiled", crash_mission(name)).touches
    }
    assert found == {(part, surface) for part in ("rotor", "guard", "beam") for surface in ("floor", "wall")}


def test_after_a_crash_no_part_is_below_the_floor():
    for name in CRASHES:
        crash = crashed_in("compiled", crash_mission(name))
        assert crash.rests[2] > crash.flight.mission["ground"]["height"]
