"""The compiled step over arrays of NumPy: the bits of a simulation, derivatives against central differences."""

from __future__ import annotations

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.differentiable.compiled_step import CompiledStep
from tandemlift.analysis.differentiable.differentiable_step import ClosedStep
from tandemlift.analysis.linearization.operating_point import flown_to
from tandemlift.core.errors import InputError
from tandemlift.simulation.plan import FlightPlan

LANES, STEPS = 5, 8
PUSHES = np.random.default_rng(1).uniform(-2.0, 2.0, (LANES, STEPS, 3))
WEIGHTS = np.random.default_rng(2).standard_normal((STEPS, 13))  # of the motion


@pytest.fixture(scope="module")
def start():
    """The compiled step of `hover`, and state and parameters at 6 s."""
    mission = tl.load_mission("hover")
    code, start, *_ = ClosedStep(FlightPlan(mission, interactive=True), "push", ()).at(flown_to(mission, 6.0))
    return CompiledStep(code, threads=2), *start


def test_each_lane_has_the_bits_of_a_simulation_with_an_action_for_each_step(start):
    step, state, parameters = start
    states = step.advance(state, parameters, PUSHES, STEPS)
    for lane in range(LANES):
        simulation = tl.Simulation("hover")
        simulation.step(steps=6000)
        for k in range(STEPS):
            simulation.step(push=PUSHES[lane, k])
            assert np.array_equal(states[lane, k, : len(state) - 1], simulation._stepper.a[: len(state) - 1])


def loss(step, state, parameters, pushes):
    """A weighted sum of the motion after each step, and its derivative by the states."""
    states = step.advance(state, parameters, pushes, STEPS)
    bars = np.zeros_like(states)
    bars[..., :13] = WEIGHTS
    return (states * bars).sum(axis=(-2, -1)), states, bars


@pytest.mark.parametrize("held", [False, True])
def test_cotangents_of_actions_are_central_differences(start, held):
    step, state, parameters = start
    pushes, h = (PUSHES[:, :1] if held else PUSHES), 1e-5
    _, states, bars = loss(step, state, parameters, pushes)
    *_, found = step.cotangent(state, parameters, pushes, states, bars, by_parameters=False)
    assert found.shape == pushes.shape
    eye = h * np.eye(pushes[0].size).reshape(-1, 1, *pushes[0].shape)  # a lane for each difference of each lane
    ahead, behind = (loss(step, state, parameters, pushes + e)[0] for e in (eye, -eye))
    differences = ((ahead - behind) / (2 * h)).T.reshape(pushes.shape)
    assert np.abs(found - differences).max() < 1e-7 * np.abs(differences).max()


def test_tangents_are_the_cotangents_times_the_direction(start):
    step, state, parameters = start
    rng = np.random.default_rng(4)
    _, states, bars = loss(step, state, parameters, PUSHES)
    sizes = np.where(np.abs(parameters) < 1e6, parameters, 0.0)  # seeds, and a limit that is infinite, stay
    directions = [sizes * rng.uniform(-1.0, 1.0, sizes.shape), rng.standard_normal(PUSHES.shape)]
    dstate = np.zeros_like(state)
    dstate[:13] = rng.standard_normal(13)
    moved = step.tangent(state, parameters, PUSHES, states, dstate, *directions)
    by_state, by_parameters, by_pushes = step.cotangent(state, parameters, PUSHES, states, bars)
    products = by_state @ dstate + by_parameters @ directions[0] + (by_pushes * directions[1]).sum(axis=(1, 2))
    assert (moved * bars).sum(axis=(1, 2)) == pytest.approx(products, rel=1e-9)
    without = step.tangent(state, parameters, PUSHES, states, dstate, None, directions[1])
    still = step.tangent(state, parameters, PUSHES, states, dstate, 0.0 * sizes, directions[1])
    assert np.allclose(without, still, rtol=1e-12, atol=1e-15)


def test_lanes_are_the_same_however_their_arrays_lie_and_threads_share_them(start):
    step, state, parameters = start
    states = step.advance(state, parameters, PUSHES, STEPS)
    own = [np.broadcast_to(x, (LANES, len(x))).copy() for x in (state, parameters)]
    assert np.array_equal(step.advance(*own, PUSHES, STEPS), states)
    wide = np.zeros((STEPS, LANES, 2, 3))[::-1, :, 0]  # steps before lanes, backward, every second row
    wide[:] = PUSHES.swapaxes(0, 1)
    assert np.array_equal(step.advance(state, own[1][:, ::-1][:, ::-1], wide.swapaxes(0, 1), STEPS), states)
    several = step.advance(state, parameters, PUSHES.reshape(1, LANES, 1, STEPS, 3), STEPS)
    assert np.array_equal(several, states.reshape(1, LANES, 1, STEPS, -1))
    many = np.repeat(PUSHES, 100, axis=0)
    for _ in range(2):  # threads share the second call
        assert np.array_equal(step.advance(state, parameters, many, STEPS), np.repeat(states, 100, axis=0))
    assert step.advance(state, parameters, PUSHES[:0], STEPS).shape == (0, STEPS, len(state))


def test_states_of_some_calls_are_those_of_one(start):
    step, state, parameters = start
    states = step.advance(state, parameters, PUSHES, STEPS)
    first = step.advance(state, parameters, PUSHES[:, :3], 3)
    second = step.advance(first[:, -1], parameters, PUSHES[:, 3:], STEPS - 3)
    assert np.array_equal(np.concatenate([first, second], axis=1), states)


def test_an_array_of_another_shape_is_refused(start):
    step, state, parameters = start
    with pytest.raises(InputError, match=r"action: an array \(5, 8, 2\): its last dimensions must be \(8, 3\)"):
        step.advance(state, parameters, PUSHES[..., :2], STEPS)
    with pytest.raises(InputError, match=r"state: an array \(4,\): its last dimensions must be"):
        step.advance(state[:4], parameters, PUSHES, STEPS)
