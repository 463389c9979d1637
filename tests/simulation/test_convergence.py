"""The sampled loop against the continuous-time loop that it samples, integrated by SciPy's DOP853."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.machine_code.machine import QUICK
from tandemlift.core.vector import ZERO, Absent
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import motion
from tandemlift.parts.pilot.pilot import PilotInput, decide
from tandemlift.parts.rotors.allocation import wrench
from tandemlift.simulation.preparation.assemble import assemble

DURATION = 6.0  # s: the lift of `paper`, from 2 to 8 s


def lifting(step):
    return tl.load_mission(
        "paper",
        {
            "mission.step": step,
            "mission.duration": DURATION,
            "mission.log_interval": 0.5,
            "phases.lift_start": 0.0,
            "pushes": [],
            "initial.position": [0.02, -0.02, 0.0],
            "initial.velocity": [0.01, 0.01, 0.0],
            "initial.euler": [0.002, -0.001, 0.003],
        },
    )


@pytest.fixture(scope="module")
def continuous():
    """Positions and attitudes of the loop whose pilot is never held, at the logged times."""
    model = assemble(lifting(0.001)).model
    begin = model.flight_state.state

    def rate(t, state):
        given = PilotInput(state, ZERO, ZERO, 0.0, Absent())
        decision, _ = decide(model.pilot, model.flight_state.memory, given, t, 1.0)
        return motion(model.plant.body, state, wrench(model.plant.effect, decision.thrusts), CentralPush(ZERO))

    code = compiled(rate, 0.0, begin, level=QUICK)
    solution = solve_ivp(
        lambda t, y: code(np.array([[t, *y]]))[0],
        (0.0, DURATION),
        np.concatenate(begin),
        method="DOP853",
        rtol=1e-8,
        atol=1e-11,
        t_eval=np.arange(0.0, DURATION + 0.25, 0.5),
    )
    assert solution.success
    return solution.y.T


@pytest.mark.thorough
def test_halving_the_step_halves_the_distance_to_the_continuous_loop(continuous):
    distances, angles = [], []
    end = Rotation.from_quat(continuous[-1, 6:10], scalar_first=True)
    for flight in tl.fly_many([lifting(step) for step in (1e-3, 5e-4, 2.5e-4)]):
        assert len(flight.time) == len(continuous)
        distances.append(np.abs(flight["position"] - continuous[:, 0:3]).max())
        angles.append((Rotation.from_quat(flight["attitude"][-1], scalar_first=True).inv() * end).magnitude())
    np.testing.assert_allclose(np.divide(distances[:-1], distances[1:]), 2.0, atol=0.1)
    np.testing.assert_allclose(np.divide(angles[:-1], angles[1:]), 2.0, atol=0.3)
    assert distances[0] < 1e-3
