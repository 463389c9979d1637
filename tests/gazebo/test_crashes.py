"""Ten crashes in Gazebo beside the compiled engine: the same outcome, and the same part touches first."""

import math

import pytest
from ten_crashes import CRASHES, crash_mission, crashed_in

pytestmark = pytest.mark.gazebo
SOON, CLOSE = 0.02, 0.05  # s, m: of the first touch


def row(name, engine, crash):
    """A crash in words: when and where it first touched, and where it comes to rest."""
    where = [
        ", ".join(f"{v + 0.0:.2f}" for v in place) for place in (*[t.place for t in crash.touches[:1]], crash.rests)
    ]
    first = [f"{t.part}, {t.surface}, {t.time:.3f} s" for t in crash.touches[:1]] or ["feet only"]
    return " | ".join([name, engine, *first, *where])


@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_ends_alike_in_gazebo_and_the_same_part_touches_first(name):
    ours, theirs = (crashed_in(engine, crash_mission(name)) for engine in ("compiled", "gazebo"))
    print(row(name, "compiled", ours), row(name, "gazebo", theirs), sep="\n")
    assert ours.flight.outcome == theirs.flight.outcome == "crashed"
    assert bool(ours.touches) == bool(theirs.touches)
    for first, other in zip(ours.touches[:1], theirs.touches[:1], strict=True):
        assert (first.part, first.surface) == (other.part, other.surface)
        assert first.time == pytest.approx(other.time, abs=SOON)
        assert math.dist(first.place, other.place) < CLOSE
