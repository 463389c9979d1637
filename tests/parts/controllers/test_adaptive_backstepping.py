"""The adaptive backstepping controller of the examples: Lyapunov's function, and flights."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.core.algebra import Vec3

FILE = Path(__file__).parents[3] / "examples" / "controllers" / "adaptive_backstepping.py"


@pytest.fixture(scope="module")
def made():
    """The controller and its module."""
    made = tl.load_controller(FILE)
    return made, sys.modules[made.start.__module__]


def test_lyapunovs_function_falls_as_derived_and_the_disturbance_is_found(made):
    """The loop of one axis under an acceleration of 0.7 m/s², integrated by SciPy."""
    c1, c2, gamma, unknown = 1.5, 2.5, 0.8, 0.7
    k = made[1].Gains(None, *(Vec3(x, x, x) for x in (c1, c2, gamma)), 9.0, None, 1e-3)

    def rate(_, y):
        u, adapted = made[1].backstepping(k, Vec3(y[2], 0.0, 0.0), Vec3(y[0], 0.0, 0.0), Vec3(y[1], 0.0, 0.0))
        return [y[1], u.x + unknown, adapted.x]

    t = np.linspace(0.0, 30.0, 3001)
    e1, de1, found = solve_ivp(rate, (0.0, t[-1]), [0.5, -0.3, 0.0], t_eval=t, rtol=1e-10, atol=1e-12).y
    e2 = de1 + c1 * e1
    V = 0.5 * (e1**2 + e2**2 + (unknown - found) ** 2 / gamma)
    assert np.gradient(V, t)[1:-1] == pytest.approx((-c1 * e1**2 - c2 * e2**2)[1:-1], abs=2e-4)
    assert found[-1] == pytest.approx(unknown, abs=1e-3)
    assert abs(e1[-1]) < 1e-3


def test_it_flies_and_takes_a_constant_force_out_by_itself(made):
    changes = {"disturbance.force": [1.0, 0.0, -1.0], "mission.duration": 30.0}
    flight = tl.fly(tl.load_mission("hover", changes, controller=made[0]))
    late = flight.time > 25.0
    assert np.abs(flight["position_error"][late]).max() < 2e-3
    lazy = tl.load_mission("hover", changes | {"controller.adaptation": 1e-6}, controller=made[0])
    m, c = tl.Vehicle.from_settings(lazy.vehicle).mass, 1.5
    assert tl.fly(lazy)["position_error"][-1, 0] == pytest.approx(-1.0 / m / (1.0 + c * c), rel=0.05)


@pytest.mark.thorough
def test_it_lands_iris(made):
    m = tl.fly(tl.load_mission("iris", controller=made[0])).metrics()
    assert m["outcome"] == "landed"
    assert np.max(m["position_rmse_after_10s_m"]) < 0.006
