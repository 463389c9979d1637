"""Parts of a loop that is cut, sectors, regions and flown offsets, against numbers that are known beforehand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.analysis.certification import cut_loop, sector_bound
from tandemlift.analysis.certification.cut_loop import OFFSET_NAMES, CutLoop, parts_of
from tandemlift.analysis.certification.intervals import bounds
from tandemlift.analysis.certification.nonlinear import OffsetBounds, OffsetFlights, _offset_claims, sectors_of
from tandemlift.analysis.certification.sector_bound import (
    LoopPart,
    Plant,
    Sectors,
    Start,
    response,
    without_resting_modes,
)
from tandemlift.analysis.linearization.loop_margins import AXES
from tandemlift.core.algebra import sin, tan
from tandemlift.core.errors import InputError
from tandemlift.parts.pilot.commanded_thrusts import RotorAxes

STEP = 1e-3


def loop(C, D, *, states=(0.9, 0.8, 0.7, 0.6), error=0.0):
    """Four axes, each with a state of its own that its φ drives."""
    A, m = np.diag(states), len(AXES)
    B = np.hstack([np.eye(m), 0.1 * np.eye(m, len(OFFSET_NAMES))])
    return CutLoop(Plant(A, B, np.array(C), np.hstack([D, np.zeros((m, len(OFFSET_NAMES)))])), AXES, STEP, error)


COUPLED = [[0.1, 20.0, 0.0, 0.0], [0.002, 0.1, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0], [0.0, 0.0, 0.0, 0.2]]
THROUGH = np.array([[0.3, 8.0, 0.0, 0.0], [0.001, 0.2, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0], [0.0, 0.0, 0.0, 0.4]])


def test_a_part_is_the_loop_between_its_cuts_in_its_own_units():
    """Cuts coupled both ways in unlike units are one part, whose response is the loop's with its channels scaled."""
    found = parts_of(loop(COUPLED, THROUGH, error=0.01), AXES, unit=0.5)
    assert [part.channels for part, _ in found] == [(0, 1), (2,), (3,)]
    z = np.exp(1j * np.array([0.01, 0.3, 2.0]))
    whole = response(Plant(np.diag((0.9, 0.8, 0.7, 0.6)), np.eye(4), np.array(COUPLED), THROUGH), z)
    for part, starts in found:
        at, s = list(part.channels), part.scale
        expected = whole[:, at][:, :, at] * s[:, None] / s
        assert response(part.plant, z) == pytest.approx(expected, abs=part.error + 1e-9)
        assert part.error >= 0.01 * s.max() / s.min()
        assert np.abs(expected).max() < 50.0
        assert len(starts) == len(OFFSET_NAMES)
    both = found[0][0]
    sizes = np.abs(response(both.plant, z)).max(axis=0)
    assert sizes[0, 1] == pytest.approx(sizes[1, 0], rel=0.2)  # balanced
    assert [part.scale for part, _ in found[1:]] == [pytest.approx([2.0])] * 2


def test_a_response_without_a_way_back_couples_nothing():
    one_way = np.array(COUPLED)
    one_way[1, 0] = 0.0
    found = parts_of(loop(one_way, np.diag(np.diag(THROUGH))), AXES)
    assert [part.channels for part, _ in found] == [(0,), (1,), (2,), (3,)]


def test_a_start_is_the_state_after_a_unit_disturbance():
    """Of the first axis alone, with one state: it shows in q as C x from the start on."""
    ((part, starts), *_) = parts_of(loop(np.diag([0.1] * 4), np.zeros((4, 4))), AXES)
    assert abs(part.plant.C @ starts[0].state) / part.scale == pytest.approx([0.1 * 0.1], rel=1e-3)
    assert part.plant.C @ starts[1].state == pytest.approx([0.0], abs=1e-9)


def test_the_results_of_a_law_are_those_that_it_does_not_use_itself():
    def law():
        pass

    def other():
        pass

    laws, ops = [law, law, law, other, law], ["in", "mul", "add", "add", "const"]
    graph = SimpleNamespace(graph=SimpleNamespace(laws=laws, ops=ops, args=[(), (0, 0), (1, 0), (2, 2), (3.0,)]))
    assert cut_loop._results(graph, frozenset({0, 1, 2, 3}), law) == [2]
    assert cut_loop._results(graph, frozenset({0, 1, 2, 3}), other) == [3]


# sectors


def part_of(*channels):
    m = len(channels)
    return LoopPart(Plant(*(np.zeros((m, m)),) * 4), channels, 0.0, np.full(m, 2.0))


def test_only_axes_of_an_allocation_share_a_multiplier_and_surfaces_have_their_own():
    found = sectors_of(part_of(0, 3, 4), (3.0, 1.0, 1.0, 1.0), 0.5)
    assert found.shared == pytest.approx([1.0, 1.0 / 9.0, 0.0])
    assert found.upper == pytest.approx([0.5] * 3)
    assert sectors_of(part_of(4), (3.0, 1.0, 1.0, 1.0), 0.5).shared == pytest.approx([0.0])
    assert sectors_of(part_of(0, 1), (), 0.5).shared == pytest.approx([0.0, 0.0])
    assert found.rows.shape == (0, 6)


def rotor_axes(room):
    """Two rotors per axis, in opposite senses: 1 N of each is the unit of each axis."""
    inverse = np.array([[1.0, 1.0, 1.0, 1.0], [1.0, -1.0, -1.0, 1.0], [1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]])
    return RotorAxes(inverse.T / 4.0, inverse, np.full(4, room), np.full(4, 3.0), np.full(4, 3.0 + room))


def test_rows_are_the_excursions_of_the_rotors_in_their_room():
    rows = sectors_of(part_of(0, 1), (1.0,) * 4, 1.0, within=rotor_axes(0.25)).rows
    assert rows.shape == (2, 4)  # two rotors move alike
    assert sorted(map(tuple, rows[:, :2])) == [(2.0, -2.0), (2.0, 2.0)]
    assert not rows[:, 2:].any()


def test_a_rotor_needs_some_room_and_none_at_all_is_refused():
    whole = loop(np.diag([0.1] * 4), np.zeros((4, 4)))
    assert OffsetBounds(whole, (1.0,) * 4, rotor_axes(0.5))._parts
    with pytest.raises(InputError, match=r"rotor 1 hovers at 3 N, and its limits are 0 and 3 N"):
        OffsetBounds(whole, (1.0,) * 4, rotor_axes(0.0))


def test_offsets_are_flown_only_where_a_bound_was_found_and_flights_are_asked_for():
    sizes = {name: 0.5 if name.endswith("x") else None for name in OFFSET_NAMES}
    found = SimpleNamespace(farthest=lambda offset: sizes[next(iter(offset))])
    asked = list[str]()
    flights = SimpleNamespace(limit=lambda name, size: asked.append(name))
    claims = list(_offset_claims(found, None, "fly"))
    assert [claim.value for claim in claims] == list(sizes.values())
    assert {claim.subject: claim.unit for claim in claims}["attitude.x"] == "rad"
    assert "(28.6 deg)" in next(c.text for c in claims if c.subject == "attitude.x")
    list(_offset_claims(found, flights, "fly"))
    assert asked == [name for name in OFFSET_NAMES if name.endswith("x")]


@pytest.mark.parametrize(("name", "most"), [("velocity.x", 6.4), ("attitude.y", math.pi)])
def test_flights_end_their_search_at_the_limit_or_at_the_largest_offset(name, most):
    flights, tried = object.__new__(OffsetFlights), list[float]()

    def recovers(offset):
        tried.append(offset[name])
        return offset[name] < 1.0

    flights.recovers = recovers
    found = flights.limit(name, 0.1)
    assert found.below < 1.0 <= found.above < 1.06 * found.below
    assert found.ended == "not at rest"
    flights.recovers = lambda offset: True
    endless = flights.limit(name, 0.1)
    assert (endless.below, endless.above, endless.ended) == (pytest.approx(most), math.inf, "")


# regions


def test_the_size_of_a_region_counts_its_start_and_twice_the_square_of_what_was_left_out():
    """x⁺ = 0.5 x + 0.1 φ, q = 0.1 x: Q = 4, µ = 2, and a start at s with e left out is within 1/√(s²/4 + 2 e²/2)."""
    part = LoopPart(Plant(*(np.array([[x]]) for x in (0.5, 0.1, 0.1, 0.0))), (0,), 0.0, np.ones(1))
    sectors = Sectors(np.ones(1), np.zeros(1), np.zeros((0, 2)))
    known = sector_bound._Unknowns(np.array([[4.0]]), np.ones(1), np.zeros((1, 1)), 1e-1)
    for s, e in ((1.0, 0.0), (1.0, 0.3), (0.2, 0.5)):
        region = sector_bound._checked(part, sectors, math.sqrt(2.0), Start(np.array([s]), e), known)
        assert region.size == pytest.approx(1.0 / math.sqrt(s * s / 4.0 + 2.0 * e * e / 0.1))
    free = sector_bound._checked(part, sectors, 1.0, None, known)
    assert free.size == math.inf
    unstable = part._replace(plant=part.plant._replace(A=np.array([[1.1]])))
    assert sector_bound._checked(unstable, sectors, 1.0, None, known) is None


def test_a_mode_at_rest_is_left_out_of_a_plant_that_shows_nothing():
    A = np.array([[1.0, 0.0], [0.3, 0.5]])
    silent = Plant(A, np.zeros((2, 1)), np.zeros((1, 2)), np.ones((1, 1)))
    assert without_resting_modes(silent).A.item() == pytest.approx(0.5)


# intervals


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 3])
def test_a_tangent_between_its_poles_is_bounded_on_every_branch(turns):
    low, high = turns * math.pi - 0.7, turns * math.pi + 1.2
    found = bounds(lambda x: [tan(x[0])], np.array([[low]]), np.array([[high]]))
    assert (found[0].item(), found[1].item()) == pytest.approx((math.tan(low), math.tan(high)))
    assert np.isnan(bounds(lambda x: [tan(x[0])], np.array([[high]]), np.array([[high + 1.0]]))).any()


def test_a_sine_reaches_one_where_its_maximum_is_just_after_the_begin():
    """π to 40 digits, so that numbers just below a maximum are known, many turns away."""
    pi = 3141592653589793238462643383279502884197  # times 1e39
    for k in range(2**33, 2**33 + 400):
        twice = (4 * k + 1) * pi  # of 2e39 times the angle
        x = float(twice) / 2e39
        numerator, denominator = x.as_integer_ratio()
        if numerator * 2 * 10**39 <= twice * denominator:  # the maximum is in [x, x + 1]
            _, high = bounds(lambda a: [sin(a[0])], np.array([[x]]), np.array([[x + 1.0]]))
            assert high.item() >= 1.0
