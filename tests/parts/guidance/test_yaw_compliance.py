"""The heading under a constant moment: J ψ̈ + C ψ̇ = M beyond the threshold, against its solution in closed form."""

import math

import pytest

from tandemlift.parts.guidance.phases import PhaseOutput
from tandemlift.parts.guidance.yaw_compliance import YawCompliance, YawState, yaw_step
from tandemlift.parts.interaction.compliance import DeadBand, DeadBandState
from tandemlift.parts.mechanics.low_pass import LowPass, LowPassState

DT, J, C = 0.02, 3.0, 1.5
AT_ONCE, REST = LowPass(0.0, 0.0, 0.0, 0.0), LowPassState(0.0, 0.0)
PUSHED = PhaseOutput(**dict.fromkeys(PhaseOutput._fields, 0.0))._replace(responding=1.0)
COMPLIANT = YawCompliance(AT_ONCE, DeadBand(0.2, 0.1, 0.0, 0.0), AT_ONCE, 1.0 / J, C, 100.0, 3.0)
STILL = YawState(REST, DeadBandState(0.0, 0.0, 0.0, 0.0, 0.0), REST, 0.3, 0.0, 0.0)


def test_a_constant_moment_turns_the_heading_as_the_admittance_does():
    memory, M = STILL, 0.9 - 0.2
    for _ in range(round(2.0 / DT)):
        _, memory = yaw_step(COMPLIANT, memory, 0.9, 0.3, PUSHED, 0.0, DT)
    tau, t = J / C, 2.0
    assert memory.rate == pytest.approx(M / C * (1.0 - math.exp(-t / tau)), rel=0.01)
    assert memory.angle - 0.3 == pytest.approx(M / C * (t - tau * (1.0 - math.exp(-t / tau))), rel=0.02)


def test_a_step_under_a_constant_acceleration_moves_the_heading_by_half_of_its_square():
    undamped = COMPLIANT._replace(damping=0.0)
    _, after = yaw_step(undamped, STILL._replace(rate=0.4), 0.9, 0.3, PUSHED, 0.0, DT)
    _, after = yaw_step(undamped, after, 0.9, 0.3, PUSHED, 0.0, DT)
    t, a = 2.0 * DT, 0.7 / J
    assert after.angle - 0.3 == pytest.approx(0.4 * t + 0.5 * a * t * t, abs=1e-12)
