"""Two flight controllers on one body fight by their integrators; shared loops hover (evidence/ flies ten minutes)."""

import numpy as np
import pytest
from two_flight_controllers import ERROR, errors_of, hover

from tandemlift.apps.clients.cascade import Demand
from tandemlift.apps.clients.one_body import together
from tandemlift.apps.clients.setpoints import EstimateError, PositionSetpoint, QuadrotorState

pytestmark = pytest.mark.thorough


def test_shared_loops_hold_a_hover_within_5_cm():
    flight = hover("shared", 40.0)
    assert flight.times[-1] == pytest.approx(40.0, abs=0.2)
    assert flight.worst < 0.05
    assert flight.against.max() < 1e-9  # one allocation never lets the quadrotors work against each other
    assert np.mean(flight.limited) == 0.0


def test_own_loops_wind_up_against_each_other_until_the_vehicle_is_lost():
    flight = hover("own", 40.0)
    assert flight.far > 1.0
    assert flight.ending != "hovers"
    assert np.all(np.diff(flight.against[10:50:10]) > 0.0)  # integrators grow, second by second
    assert flight.against.max() > 1e-3


@pytest.mark.parametrize(("apart", "yaw"), [(0.5, 0.7), (0.3, 0.7), (0.02, 0.4), (0.0, 0.4)])
def test_targets_turn_the_body_unless_they_are_together(apart, yaw):
    """Two targets along a line at 0.7 rad, of quadrotors that ask for yaws of 0.3 and 0.5 rad."""
    c, s = 0.5 * apart * np.cos(0.7), 0.5 * apart * np.sin(0.7)
    demands = [
        Demand(1.0, yaw=0.3, target=(3.0 + c, 4.0 + s, 1.0)),
        Demand(1.0, yaw=0.5, target=(3.0 - c, 4.0 - s, 1.0)),
    ]
    assert together(demands, [(0.25, 0.0, 0.0), (-0.25, 0.0, 0.0)]).yaw == pytest.approx(yaw)


def test_an_error_of_an_estimate_is_that_rotation():
    state = QuadrotorState(0.0, (1.0, 2.0, 3.0), (0.0,) * 3, (1.0, 0.0, 0.0, 0.0), (0.0,) * 3, (0.0,) * 3, (0.0,) * 4)
    estimate = ERROR.of(state)
    assert estimate.euler == pytest.approx(ERROR.rotation, abs=4e-4)  # of the second order
    assert np.linalg.norm(estimate.quaternion) == pytest.approx(1.0)
    assert estimate.position == pytest.approx((1.01, 2.01, 3.01))
    assert EstimateError().of(state) == state
    assert errors_of(1.0)[1].rates == pytest.approx([-0.5 * x for x in ERROR.rates])


def fly_to(pair, height, seconds):
    """Send both to a height [m], above where they stand; their places."""
    targets = [(x, y, height) for x, y, _ in pair.quads.vehicle.lever_arms.tolist()]
    pair.seconds(seconds, lambda: [pair.quads.command(i, PositionSetpoint(t, 0.0)) for i, t in enumerate(targets)])
    return targets


def test_a_vehicle_whose_quadrotors_have_own_loops_hovers_where_nothing_is_off(pairs):
    pair = pairs("own")
    for i, target in enumerate(fly_to(pair, 0.6, 8.0)):
        assert pair.state(i).position == pytest.approx(target, abs=0.02)
