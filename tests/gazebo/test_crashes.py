"""Ten crashes in Gazebo beside the compiled engine: the same outcome, and the same part first."""

import pytest

from tandemlift.studies.crashes import CRASHES, apart, crash_in

pytestmark = pytest.mark.gazebo


@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_ends_alike_and_begins_with_the_same_part(name):
    a, b = crash_in(name, "compiled"), crash_in(name, "gazebo")
    print(f"{name}: comes to rest at {a.rest} (compiled), {b.rest} (gazebo)")
    assert a.outcome == b.outcome == "crashed"
    if a.first is None:  # feet are no part that must not touch
        assert b.first is None
        return
    assert b.first is not None
    assert b.first[:2] == a.first[:2]  # part and surface
    time, place = apart(a.first, b.first)
    assert time < 0.02  # s
    assert place < 0.05  # m
