"""Ten crashes in two engines that share no contact law: the same outcome, and the same part touches first."""

from __future__ import annotations

import functools
import math

import pytest
from ten_crashes import CRASHES, crash_mission, crashed_in

pytest.importorskip("mujoco")

SOON, CLOSE = 0.02, 0.05  # s, m: of the first touch
UNTOUCHED = ["fallen from 2 m at a stop"]  # it lands on its feet


@functools.cache
def crash(name, engine="compiled"):
    """A crash in an engine, flown once."""
    return crashed_in(engine, crash_mission(name))


@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_ends_alike_in_mujoco_above_the_floor_and_the_same_part_touches_first(name):
    ours, theirs = crash(name), crash(name, "mujoco")
    assert ours.flight.outcome == theirs.flight.outcome == "crashed"
    assert ours.rests[2] > ours.flight.mission["ground"]["height"]
    if name in UNTOUCHED:
        assert ours.touches == theirs.touches == []
        return
    first, other = ours.touches[0], theirs.touches[0]
    assert (first.part, first.surface) == (other.part, other.surface)
    assert first.time == pytest.approx(other.time, abs=SOON)
    assert math.dist(first.place, other.place) < CLOSE
    assert first.force == pytest.approx(other.force, rel=0.5)
    found = next(finding for finding in ours.flight.findings if finding.kind == "touched")
    assert found.quantity == f"{first.part} on {first.surface}"
    assert (found.place, found.value) == (first.place, first.force)
    assert found.time == pytest.approx(first.time)


def test_the_crashes_touch_with_every_kind_of_part_on_floor_and_walls():
    found = {(t.part.split()[0], t.surface) for name in CRASHES for t in crash(name).touches}
    assert found == {(part, surface) for part in ("rotor", "guard", "beam") for surface in ("floor", "wall")}
