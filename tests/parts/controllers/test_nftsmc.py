"""The paper's controller: it makes the model do what the sliding law wants, and its errata by their numbers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import IRIS, array, free_body, random_state, random_vec3, seeds
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.core.trajectories import Trajectory
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.controllers import Measured, Reference, control
from tandemlift.parts.controllers.attitude_reference import (
    AttitudeReference,
    CommandFilter,
    CommandFilterState,
    command_filter,
    shape_reference,
)
from tandemlift.parts.controllers.nftsmc import NFTSMC, BodyRates, ExactRates, attitude_law, euler_rates, position_law
from tandemlift.parts.controllers.sliding_surface import Saturation, switching, wanted_acceleration
from tandemlift.parts.mechanics.equations_of_motion import GeneralizedVector, euler_dynamics, expanded_dynamics
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import (
    euler_from_quaternion,
    euler_rates_from_rates,
    quaternion_from_euler,
    wrap_angle,
)
from tandemlift.simulation.preparation.assemble import assemble

DRAG = Vec3(0.1, 0.2, 0.3)
MEMORY = assemble(tl.load_mission("paper")).model.flight_state.memory.controller


def paper_controller(**changes) -> NFTSMC:
    """The paper's gains on the paper's vehicle, with more drag, so that a missing term shows."""
    settings = {f"controller.{key}": value for key, value in changes.items()}
    k = assemble(tl.load_mission("paper", settings)).model.pilot.controller
    return k._replace(drag_force=DRAG, drag_moment=DRAG)


K = paper_controller()
BODY = free_body(K.mass, np.diag(K.inertia))._replace(drag_force=DRAG, drag_moment=DRAG)


def random_reference(rng: np.random.Generator) -> Trajectory:
    return Trajectory(random_vec3(rng), random_vec3(rng), random_vec3(rng))


@given(seeds)
def test_the_position_law_makes_the_model_accelerate_as_the_surface_wants(seed):
    """p̈ = p̈_d + (ξ + ηa|e|ᵃ⁻¹)ė + λ₁S + λ₂ sw(S) with drag and weight cancelled."""
    rng = np.random.default_rng(seed)
    state, desired = random_state(rng), random_reference(rng)
    u = position_law(K, state, desired, ZERO)
    moved = expanded_dynamics(BODY, state.velocity, ZERO, GeneralizedVector(u, ZERO)).position
    wanted = wanted_acceleration(K.position, desired.position - state.position, desired.velocity - state.velocity)
    scale = 1.0 + np.abs(array(wanted)).max()
    assert array(moved) == pytest.approx(array(desired.acceleration + wanted), abs=1e-13 * scale)


def test_without_the_mass_the_reference_acceleration_is_not_reached():
    """Erratum pos_cont_equ: ÿ_d alone moves the vehicle by ÿ_d/m_t, and the z gains act by 1/m_t."""
    at_rest = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
    desired = Trajectory(ZERO, ZERO, Vec3(0.0, 1.0, 0.0))
    right = position_law(K, at_rest, desired, ZERO).y
    assert right == pytest.approx(3.5)  # N for 1 m/s²; printed, 1 N
    assert 1.0 / right == pytest.approx(0.286, abs=5e-4)


@given(seeds)
def test_the_attitude_law_makes_the_model_turn_as_the_surface_wants(seed):
    """Θ̈ = Θ̈_d + the wanted acceleration, under Assumption 4, with gyroscopic terms and drag cancelled."""
    rng = np.random.default_rng(seed)
    e = euler_from_quaternion(quaternion_from_euler(random_vec3(rng, 0.3)))
    rates = random_vec3(rng)
    desired = AttitudeReference(*(random_vec3(rng) for _ in range(3)))
    moment = attitude_law(K, e, rates, desired)
    moved = expanded_dynamics(BODY, ZERO, rates, GeneralizedVector(ZERO, moment)).attitude
    error = wrap_angle(desired.angles - e.angles)
    wanted = wanted_acceleration(K.attitude, error, desired.rates - rates)
    scale = 1.0 + np.abs(array(wanted)).max()
    assert array(moved) == pytest.approx(array(desired.accelerations + wanted), abs=1e-12 * scale)


@given(seeds)
def test_the_whole_controller_lifts_and_turns_the_model_as_wanted(seed):
    """Thrust gives the wanted vertical force at any tilt; the moments give the wanted Θ̈."""
    rng = np.random.default_rng(seed)
    e = euler_from_quaternion(quaternion_from_euler(random_vec3(rng, 0.3)))
    state = random_state(rng)._replace(attitude=quaternion_from_euler(e.angles))
    reference = Reference(random_reference(rng), 0.0)
    command, _ = control(K, MEMORY, Measured(state, ZERO), reference)
    rates = euler_rates_from_rates(e, state.rates)
    moved = euler_dynamics(BODY, e, state.velocity, rates, command.wrench)
    T = reference.trajectory
    lift = T.acceleration + wanted_acceleration(K.position, T.position - state.position, T.velocity - state.velocity)
    turn = wanted_acceleration(K.attitude, command.euler - e.angles, -rates)
    assert moved.position.z == pytest.approx(lift.z, abs=1e-11 * (1.0 + abs(lift.z)))
    assert array(moved.attitude) == pytest.approx(array(turn), abs=1e-11 * (1.0 + np.abs(array(turn)).max()))


def test_the_inertia_in_the_attitude_law_is_the_whole_vehicles():
    """Erratum xsi_seprate_equ: J_x is one quadrotor's in Table II, 111 times less than J_tx."""
    ratio = np.array(K.inertia) / np.array(IRIS["inertia"])
    assert ratio == pytest.approx([110.81, 2.104, 59.34], rel=1e-3)


def test_the_printed_yaw_switching_is_one_over_the_layer_too_strong():
    """Erratum control_final_equ: sat(S_ψ)/Φ asks for λ₂/Φ outside the layer, sat(S_ψ/Φ) for λ₂."""
    k = paper_controller(switching="saturation")
    assert isinstance(k.attitude.switching, Saturation)
    S = Vec3(0.0, 0.0, 0.5)
    right = k.attitude.lambda_2.z * switching(k.attitude.switching, S).z
    printed = k.attitude.lambda_2.z * np.clip(S.z / 0.1, -1.0, 1.0) / 0.1
    assert right == pytest.approx(30.0)
    assert printed == pytest.approx(300.0)


def test_the_measured_push_is_fed_forward_where_asked():
    k, F = paper_controller(human_force_feedforward=True), Vec3(3.0, -2.0, 1.0)
    rng = np.random.default_rng(1)
    state, desired = random_state(rng), random_reference(rng)
    with_push, without = (position_law(k, state, desired, push) for push in (F, ZERO))
    assert array(without - with_push) == pytest.approx(array(F), abs=1e-12)
    assert position_law(K, state, desired, F) == position_law(K, state, desired, ZERO)


def test_euler_rates_are_exact_or_the_body_rates():
    e = euler_from_quaternion(quaternion_from_euler(Vec3(0.3, 0.2, 0.1)))
    rates = Vec3(0.1, 0.2, 0.3)
    assert euler_rates(BodyRates(), e, rates) == rates
    assert euler_rates(ExactRates(), e, rates) == euler_rates_from_rates(e, rates)


@given(seeds)
def test_the_command_filter_is_exact_for_a_held_command(seed):
    """Against ẍ = ω_f²(Θ_d − x) − 2ω_f ẋ by SciPy, over one step."""
    rng = np.random.default_rng(seed)
    bandwidth, step = float(rng.uniform(5.0, 80.0)), 0.01
    memory, desired = CommandFilterState(random_vec3(rng), random_vec3(rng)), random_vec3(rng)
    tracked, after = shape_reference(command_filter(bandwidth, step), memory, desired)

    def rate(t, y):
        return np.concatenate([y[3:], bandwidth**2 * (array(desired) - y[:3]) - 2.0 * bandwidth * y[3:]])

    y0 = np.concatenate([array(memory.angles), array(memory.rates)])
    y = solve_ivp(rate, (0.0, step), y0, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    assert np.concatenate([array(after.angles), array(after.rates)]) == pytest.approx(y, abs=1e-9)
    assert tracked.angles == memory.angles
    assert tracked.rates == memory.rates
    assert array(tracked.accelerations) == pytest.approx(rate(0.0, y0)[3:], rel=1e-12, abs=1e-9)


def smooth_filter(bandwidth):
    """A command filter behind a low-pass of the same bandwidth, ω⁴/(s + ω)⁴, and its memory at rest."""
    filters = {"attitude_reference_derivatives": "filtered", "filter_bandwidth": bandwidth}
    changes = {f"controller.{key}": value for key, value in (filters | {"smoothing_bandwidth": bandwidth}).items()}
    model = assemble(tl.load_mission("paper", changes)).model
    return model.pilot.controller.derivatives, model.flight_state.memory.controller


def test_noise_in_the_accelerations_of_a_smooth_reference_is_that_of_the_closed_form():
    """White noise σ every h leaves s² ω⁴/(s + ω)⁴ with σ √(h ω⁵/32): √(Σ g²) of the impulse response g."""
    bandwidth = 40.0
    k, memory = smooth_filter(bandwidth)
    squares = 0.0
    for i in range(1000):
        tracked, memory = shape_reference(k, memory, Vec3(0.0 if i else 1.0, 0.0, 0.0))
        squares += tracked.accelerations.x**2
    assert np.sqrt(squares) == pytest.approx(np.sqrt(0.001 * bandwidth**5 / 32.0), rel=0.05)  # ω h = 0.04


def test_the_settings_pick_the_types():
    k = paper_controller(attitude_reference_derivatives="filtered", filter_bandwidth=20.0, euler_rates="body")
    assert isinstance(k.derivatives, CommandFilter)
    assert isinstance(k.rates, BodyRates)
    assert k.derivatives.bandwidth == 20.0
    assert k.feedforward == 0.0
