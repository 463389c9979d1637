"""How the vehicle yields to a hand: dead-band, bias, limits, heading, passivity."""

import math

import numpy as np
import pytest
from guided import hand_guidance
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.core.low_pass import LowPass, LowPassState
from tandemlift.core.phases import GUIDED
from tandemlift.core.trajectories import SmoothStep
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.guidance.compliance import compensated_push, compliance_step
from tandemlift.parts.guidance.dead_band import BIAS_CLIP, QUIET_TIME, DeadBand, DeadBandState, dead_band
from tandemlift.parts.guidance.energy_tank import EnergyTank, EnergyTankState, passivity_damping
from tandemlift.parts.guidance.phases import PhaseOutput
from tandemlift.parts.guidance.yaw_compliance import YawCompliance, YawState, yaw_step
from tandemlift.parts.mechanics.vehicle import Vehicle

H = 1e-3
BAND = DeadBand(0.3, 0.2, 0.016, 1.0 / 20.0)
DEAF = DeadBandState(0.0, 0.0, 0.0, 0.0, 0.0)
RAMP = SmoothStep(1.0, 0.0, 0.0)
STEERED = PhaseOutput(GUIDED, 0.0, 1.0, 1.0, 1.0, RAMP, RAMP, 0.0, 1.0)


def heard(force, seconds, band=BAND, memory=DEAF):
    """What is heard of a force f(t) [N] at every step, and the memory at the end."""
    out = []
    for i in range(round(seconds / H)):
        beyond, memory = dead_band(band, memory, force(i * H), 1.0, H)
        out.append(beyond)
    return np.array(out), memory


def guided(changes=None):
    """The compliance of mission one-push, and its memory."""
    mission = tl.load_mission(
        "one-push", {"pilot.guidance": "interactive", "admittance.gate": "soft", **(changes or {})}
    )
    return hand_guidance(mission)


def motion(push, seconds, changes=None, across=100.0):
    """Position, velocity, acceleration and jerk at every step under a push F(t) [N]."""
    g, m = guided(changes)
    k, m, out = g.compliance, m.compliance, []
    for i in range(round(seconds / H)):
        m = compliance_step(k, m, vec3(push(i * H)), 1.0, 0.0, across, Absent(), H, Absent(), Absent())
        out.append([*m.position, *m.velocity, *m.acceleration, *m.jerk])
    return np.array(out).reshape(-1, 4, 3).swapaxes(0, 1)


def test_a_push_is_heard_after_its_dwell_and_over_below_the_release():
    out, _ = heard(lambda t: 0.5 if t < 1.0 else 0.25 if t < 2.0 else 0.15 if t < 3.0 else 0.31, 3.2)
    assert not out[:15].any()
    assert out[16:1000] == pytest.approx(0.2)
    assert not out[1000:3015].any()  # nothing beyond the threshold, and then the dwell again
    assert out[3016:] == pytest.approx(0.01)


def test_a_flicker_shorter_than_the_dwell_is_never_heard():
    out, _ = heard(lambda t: 1.0 if (t % 0.02) < 0.0145 else 0.0, 2.0)
    assert not out.any()


def test_a_bias_is_learned_while_nobody_pushes_and_bounds_the_drift():
    _, memory = heard(lambda t: 0.08, 80.0)
    assert memory.bias == pytest.approx(0.08, abs=0.01)
    out, _ = heard(lambda t: 0.35, 1.0, memory=memory)
    assert not out.any()  # less than the threshold beyond the bias


def test_blows_shorter_than_the_dwell_teach_the_bias_no_more_than_a_fraction_of_the_threshold():
    """However hard: the mean follows a force that is cut at `BIAS_CLIP` of the threshold, at its own rate."""
    for size in (0.2, 3.0, 300.0):
        out, memory = heard(lambda t, size=size: size if (t % 0.1) < 0.0095 else 0.0, 12.0)
        assert not out.any()
        assert 0.0 < memory.mean <= 0.3 * BAND.threshold * BAND.bias_rate * 12.0 * 0.11
    _, memory = heard(lambda t: 0.25, 3.0)
    learning = 3.0 - QUIET_TIME
    assert memory.mean == pytest.approx(BIAS_CLIP * BAND.threshold * BAND.bias_rate * learning, rel=0.01)


def test_the_beginning_of_a_push_is_no_bias():
    before, memory = heard(lambda t: 3.0 * np.exp(-((t - 5.0) ** 2) / 0.72), 10.0)
    assert abs(memory.bias) < 0.004
    t = np.arange(10000) * H
    true = 3.0 * np.exp(-((t - 5.0) ** 2) / 0.72)
    assert before.sum() * H == pytest.approx(np.maximum(true - 0.3, 0.0).sum() * H, rel=0.01)


def test_the_trajectory_is_that_of_the_filtered_admittance_where_no_limit_acts():
    a, b, M, C = 36.0, 60.0, 1.0, 1.6

    def push(t):
        return 2.0 / (1.0 + np.exp(-20.0 * (t - 1.0)))

    def rate(t, y):
        f, df, g, dg, _x, v = y
        beyond = f - np.clip(f, -0.3, 0.3)
        return [df, a * a * (push(t) - f) - 2 * a * df, dg, b * b * (beyond - g) - 2 * b * dg, v, (g - C * v) / M]

    reference = solve_ivp(rate, (0.0, 4.0), np.zeros(6), rtol=1e-9, atol=1e-12, max_step=0.01, dense_output=True)
    position, velocity, *_ = motion(lambda t: (push(t), 0.0, 0.0), 4.0)
    t = np.arange(1, 4001) * H
    assert np.abs(position[:, 0] - reference.sol(t)[4]).max() < 0.004
    assert np.abs(velocity[:, 0] - reference.sol(t)[5]).max() < 0.008


@pytest.mark.thorough
def test_no_push_makes_it_faster_or_more_abrupt_than_its_limits():
    changes = {"compliance.max_speed": 0.5, "compliance.max_acceleration": 1.2, "compliance.max_jerk": 6.0}
    rng = np.random.default_rng(1)
    steps = rng.normal(0.0, 40.0, (20, 3))
    _position, velocity, acceleration, jerk = motion(lambda t: steps[int(t / 0.5)], 10.0, changes)
    assert np.abs(jerk).max() <= 6.0 * (1.0 + 1e-6)
    assert np.abs(acceleration).max() <= 4.0 * 2.0 * 0.5 + 1e-9  # it may brake harder than it accelerates
    assert np.abs(velocity).max() < 0.5 * 1.25  # by what a limited jerk overshoots
    assert np.abs(np.diff(velocity[:, 0]) / H).max() <= np.abs(acceleration[:, 0]).max() + 1e-9


def test_acceleration_keeps_within_what_the_rotors_can_still_give():
    _, _, acceleration, _ = motion(lambda t: (30.0, 40.0, 0.0), 0.6, across=0.7)
    assert np.hypot(acceleration[:, 0], acceleration[:, 1]).max() <= 0.7 + 1e-9
    assert acceleration[-1, 1] > acceleration[-1, 0] * 0.9  # towards the push, as far as jerk lets it


def test_a_feel_is_what_the_trajectory_does():
    changes = {"admittance.feel": {"force": 1.3, "speed": 0.6, "time": 0.5}, "compliance.output_bandwidth": 2000.0}
    _, velocity, *_ = motion(lambda t: (1.3, 0.0, 0.0), 4.0, changes | {"compliance.input_bandwidth": 2000.0})
    assert velocity[-1, 0] == pytest.approx(0.6, rel=1e-3)
    after = np.flatnonzero(velocity[:, 0] > 0.95 * 0.6)[0] * H
    assert after == pytest.approx(0.5, abs=0.15)  # the dwell, and the jerk that is allowed


def test_beyond_the_yaw_authority_it_yields_and_brakes_with_no_more_than_that():
    g, m = guided({"compliance.yaw.model": "compliant"})
    J = Vehicle.from_settings(tl.load_mission("one-push").vehicle).inertia[2, 2]
    heading, yaw, asked = m.heading, 0.0, []
    for i in range(14000):
        moment = 3.0 if i < 2000 else 0.0
        course, heading = yaw_step(g.heading, heading, moment, yaw, STEERED, 0.0, H)
        yaw = course.angle
        asked.append(J * heading.acceleration - heading.output.value)  # what the rotors are to give
    assert abs(heading.rate) < 0.05
    assert np.abs(asked).max() <= 0.9 + 1e-9
    assert min(np.array(asked)[2200:]) == pytest.approx(-0.9, abs=1e-6)


def test_a_damping_about_yaw_that_is_unstable_when_sampled_is_refused():
    light = {"compliance.yaw.model": "compliant", "compliance.yaw.inertia": 1e-3}
    g, m = guided(light)
    for damping, settles in ((1.9, True), (2.1, False)):
        heading, yaw = m.heading, 0.0
        for _ in range(3000):
            course, heading = yaw_step(g.heading._replace(damping=damping), heading, 0.3, yaw, STEERED, 0.0, H)
            yaw = course.angle
        assert (heading.rate == pytest.approx(0.15 / damping, abs=1e-3)) == settles
    with pytest.raises(InputError, match=r"must be at most 2\*inertia/step = 2 N m s with inertia 0\.001"):
        guided({**light, "compliance.yaw.damping": 2.1})
    with pytest.raises(InputError, match=r"with inertia 3\.27"):
        guided({"compliance.yaw.model": "compliant", "compliance.yaw.damping": 7000.0})


def test_a_heading_waits_for_a_vehicle_that_cannot_turn():
    g, m = guided({"compliance.yaw.model": "compliant", "compliance.yaw.max_lead_angle": 0.3})
    heading = m.heading
    for _ in range(5000):
        _, heading = yaw_step(g.heading, heading, 1.0, 0.0, STEERED, 0.0, H)
    assert heading.angle == pytest.approx(0.3)


def test_on_the_ground_the_heading_is_that_of_the_vehicle_however_it_is_turned():
    g, m = guided({"compliance.yaw.model": "compliant"})
    for grounded in (1.0, 0.0):
        heading, yaw = m.heading._replace(rate=0.3), 0.0
        for i in range(2000):
            yaw = 0.2 * np.sin(3.0 * i * H)  # as the ground lets it turn
            _, heading = yaw_step(g.heading, heading, 1.0, yaw, STEERED._replace(grounded=grounded), 0.0, H)
            assert not grounded or (heading.angle, heading.rate) == (pytest.approx(yaw, abs=1e-15), 0.0)
    assert heading.angle - yaw > 0.1  # in the air it leads


def swing(tank, seconds=20.0):
    """The largest swing in the last second of a vehicle that follows late and is held by a spring [m]."""
    late, stiffness, M, C = 120, 60.0, 1.0, 1.6
    history, v, x, m, far = [0.02] * (late + 1), 0.0, 0.02, EnergyTankState(2.0, 0.0), []
    for i in range(round(seconds / H)):
        force = -stiffness * history[-late]
        actual = (history[-late] - history[-late - 1]) / H
        extra = 0.0
        if tank:
            extra, m = passivity_damping(tank, m, Vec3(force, 0.0, 0.0), Vec3(actual, 0.0, 0.0), C * v * v, H)
        v += (force - (C + extra) * v) / M * H
        x += v * H
        history.append(x)
        far.append(abs(x) if i > seconds / H - 1000 else 0.0)
    return max(far)


def test_energy_that_runs_out_adds_the_damping_that_keeps_a_stiff_hand_from_swinging_it_up():
    tank = EnergyTank(2.0, 1.0, 40.0, 0.0, 0.5)
    free, kept = swing(None, 6.0), swing(tank, 20.0)
    assert free > 1.0  # without, two centimetres become metres within six seconds
    assert kept < 0.5
    energy = [passivity_damping(tank, EnergyTankState(e, 0.0), ZERO, ZERO, 0.0, H)[0] for e in (2.0, 1.0, 0.5, 0.0)]
    assert energy == [0.0, 0.0, 20.0, 40.0]


def test_damping_that_was_added_decays_exponentially_once_the_tank_is_full():
    tank, full = EnergyTank(2.0, 1.0, 40.0, 0.0, 0.5), EnergyTankState(2.0, 1.0)
    for i in range(1, 4001):
        damping, full = passivity_damping(tank, full, ZERO, ZERO, 0.0, H)
        assert damping == pytest.approx(40.0 * np.exp(-0.5 * i * H), rel=2e-3)
    assert full.energy == 2.0


def test_leads_along_z_are_those_of_x_and_y_until_they_have_their_own():
    m = guided()[1].compliance._replace(filtered=LowPassState(Vec3(1.0, 1.0, 1.0), Vec3(2.0, 2.0, 2.0)))
    lead = {"compliance.force_lead": 0.1, "compliance.reference_lead": 0.2}
    alike = guided(lead)[0].compliance
    assert compensated_push(alike, m) == pytest.approx((1.2, 1.2, 1.2))
    vertical = {"compliance.vertical_force_lead": 0.03, "compliance.vertical_reference_lead": 0.0}
    own = guided(lead | vertical)[0].compliance
    assert compensated_push(own, m) == pytest.approx((1.2, 1.2, 1.06))
    assert own.reference_lead == (0.2, 0.2, 0.0)
    assert alike.reference_lead == 0.2


@pytest.mark.thorough
def test_an_identified_mass_is_accelerated_with_the_reference():
    """A heavier vehicle than assumed follows a push along x more closely, once tared."""
    changes = {"plant.mass_scale": 1.12, "pilot.state": "truth", "mission.duration": 26.0, "phases.land_start": 60.0}
    error = {}
    for known in (False, True):
        flight = tl.fly(tl.load_mission("iris", {**changes, "compliance.mass_feedforward": known}))
        off = (flight["reference_position"] - flight["position"])[flight.time > 20.0, 0]
        error[known] = np.sqrt(np.mean(off**2))
    assert error[True] < 0.85 * error[False]


def test_a_mass_that_nobody_identifies_is_not_accelerated():
    with pytest.raises(tl.InputError, match=r"compliance\.mass_feedforward = true.*estimator\.identify_mass = true"):
        tl.load_mission("iris", {"compliance.mass_feedforward": True, "estimator.identify_mass": False})


STEP, INERTIA, DAMPING = 0.02, 3.0, 1.5
AT_ONCE, REST = LowPass(0.0, 0.0, 0.0, 0.0), LowPassState(0.0, 0.0)
PUSHED = PhaseOutput(**dict.fromkeys(PhaseOutput._fields, 0.0))._replace(responding=1.0)
COMPLIANT = YawCompliance(AT_ONCE, DeadBand(0.2, 0.1, 0.0, 0.0), AT_ONCE, 1.0 / INERTIA, DAMPING, 100.0, 3.0)
STILL = YawState(REST, DeadBandState(0.0, 0.0, 0.0, 0.0, 0.0), REST, 0.3, 0.0, 0.0)


def test_a_constant_moment_turns_the_heading_as_the_admittance_does():
    """J ψ̈ + C ψ̇ = M beyond the threshold, against its solution in closed form."""
    memory, M = STILL, 0.9 - 0.2
    for _ in range(round(2.0 / STEP)):
        _, memory = yaw_step(COMPLIANT, memory, 0.9, 0.3, PUSHED, 0.0, STEP)
    tau, t = INERTIA / DAMPING, 2.0
    assert memory.rate == pytest.approx(M / DAMPING * (1.0 - math.exp(-t / tau)), rel=0.01)
    assert memory.angle - 0.3 == pytest.approx(M / DAMPING * (t - tau * (1.0 - math.exp(-t / tau))), rel=0.02)


def test_a_step_under_a_constant_acceleration_moves_the_heading_by_half_of_its_square():
    undamped = COMPLIANT._replace(damping=0.0)
    _, after = yaw_step(undamped, STILL._replace(rate=0.4), 0.9, 0.3, PUSHED, 0.0, STEP)
    _, after = yaw_step(undamped, after, 0.9, 0.3, PUSHED, 0.0, STEP)
    t, a = 2.0 * STEP, 0.7 / INERTIA
    assert after.angle - 0.3 == pytest.approx(0.4 * t + 0.5 * a * t * t, abs=1e-12)
