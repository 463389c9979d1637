"""The working set from which the search for thrusts within limits starts: that of the last sample, made feasible."""

from tandemlift.core.vector import each
from tandemlift.parts.rotors.allocation import AllocationState
from tandemlift.parts.rotors.thrust_limit_solver import feasible

FOUR = each(4)


def test_held_rotors_stand_at_their_limit_free_ones_within_and_those_that_are_lost_at_none():
    limits, thrusts = FOUR(5.0, 5.0, 5.0, 0.0), FOUR(2.0, 3.0, 9.0, 4.0)
    start = feasible(limits, AllocationState(FOUR(-1.0, 1.0, 0.0, 0.0), thrusts))
    assert tuple(start.active) == (-1.0, 1.0, 0.0, -1.0)
    assert tuple(start.thrusts) == (0.0, 5.0, 5.0, 0.0)
