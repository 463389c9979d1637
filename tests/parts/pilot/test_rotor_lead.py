"""The lead of a wrench: against scipy's discretisation of its transfer function, and against a rotor's lag."""

import numpy as np
import pytest

from tandemlift.core.vector import Absent, Vec3
from tandemlift.missions import load_mission
from tandemlift.missions.facts import Facts
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.pilot.rotor_lead import lead_step, start_lead
from tandemlift.parts.rotors.allocation import AllocationTable

H = 1e-3
TABLE = AllocationTable(lead=(0.01, 0.02, 0.03, 0.0), lead_bandwidth=150.0)


def led(table, wrenches, weight=0.0):
    """Rows thrust, roll, pitch, yaw [N, N m] of the led wrench, sample by sample."""
    k, memory = start_lead(table, weight, H, hovers=True)
    rows = []
    for thrust, *moment in wrenches:
        u, memory = lead_step(k, memory, Wrench(thrust, Vec3(*moment)))
        rows.append([u.thrust, *u.moment])
    return np.array(rows)


def test_the_lead_of_each_component_has_the_response_of_its_transfer_function():
    """(1 + T s)/(1 + s/ω)², discretised by scipy for an input that is held, a sample ahead."""
    signal = pytest.importorskip("scipy.signal")
    given = np.random.default_rng(0).normal(size=(400, 4))
    found = led(TABLE, given.tolist())
    for i, time in enumerate(TABLE.lead):
        w = TABLE.lead_bandwidth
        continuous = np.array([[0.0, 1.0], [-(w**2), -2.0 * w]]), np.array([[0.0], [w**2]]), np.array([[1.0, time]])
        A, B, C, _, _ = signal.cont2discrete((*continuous, np.zeros((1, 1))), H)
        x, expected = np.zeros((2, 1)), []
        for u in given[:, i]:
            x = A @ x + B * u
            expected.append((C @ x).item())
        assert found[:, i] == pytest.approx(expected, abs=1e-9 * w)


def test_a_steady_wrench_passes_as_it_is_from_a_hover_on():
    found = led(TABLE, [[34.0, 0.0, 0.0, 0.0]] * 50, weight=34.0)
    assert found == pytest.approx(np.tile([34.0, 0.0, 0.0, 0.0], (50, 1)), abs=1e-12)


def test_without_lead_time_the_wrench_is_the_controllers_own():
    k, memory = (held["lead"] for held in Facts(load_mission("paper")).started("pilot"))
    u = Wrench(3.0, Vec3(1.0, 2.0, 3.0))
    assert (k, memory) == (Absent(), Absent())
    assert lead_step(k, memory, u) == (u, memory)
    assert not any(load_mission("paper").allocation.lead)
