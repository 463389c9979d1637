"""`tl.jax_step`: the bits of a simulation; derivatives against differences and those that CasADi confirmed."""

from __future__ import annotations

import copy
import gc
import weakref
from functools import cache

import numpy as np
import pytest
from linearized import QUIET, linearized

import tandemlift as tl
from tandemlift.core.errors import InputError

pytestmark = pytest.mark.usefixtures("jax")

WEAK = {  # rotors that can do little more than hover, and follow although no thrust is left
    **{f"vehicle.quadrotors.{i}.max_speed": 862.0 for i in (0, 1)},
    **{"compliance.thrust_fraction": 1.0, "compliance.following.time": 5.0},
}


@cache
def step_of(name, actions="push", begin=0.0, steps=1, channels=()):
    return tl.jax_step(name, actions=actions, begin=begin, steps=steps, channels=channels)


def flown(step, simulation, actions):
    """The state of a step and of a simulation, in turn, with actions by name."""
    import jax

    call, state = jax.jit(step), step.state
    for action in actions:
        state = call(state, step.parameters, np.concatenate(list(action.values())))
        simulation.step(**action)
    return np.array(state), simulation


@pytest.mark.parametrize(
    ("name", "actions"),
    [
        ("paper", [{"push": np.array([0.3 * k % 2, -0.5, 0.1])} for k in range(60)]),
        ("hover", [{"thrusts": np.linspace(2.0, 2.1, 8) + 0.01 * k} for k in range(40)]),
        ("one-push", [{"velocity": np.array([0.4, 0.1 * (k % 5), 0.0])} for k in range(40)]),
    ],
)
def test_a_step_has_the_bits_of_a_simulation(name, actions):
    step, simulation = step_of(name, next(iter(actions[0]))), tl.Simulation(name)
    state, simulation = flown(step, simulation, actions)
    size = step.state_names.index("step")
    assert state[size] == len(actions)
    assert np.array_equal(state[:size], simulation._stepper.a[:size], equal_nan=True)


def carried(step, jax, steps, weights):
    """A weighted sum of the motion after some steps with one push, as a function of parameters and push."""

    def loss(parameters, push):
        end, _ = jax.lax.scan(lambda x, _: (step(x, parameters, push), None), step.state, None, length=steps)
        return weights @ end[:13]

    return jax.jit(loss)


def test_the_gradient_of_two_seconds_is_a_central_difference(jax):
    step, push, h = step_of("paper", begin=6.0), np.array([0.5, 0.2, -0.1]), 1e-5
    loss = carried(step, jax, 2000, np.arange(1.0, 14.0))
    by_parameters, by_push = jax.jit(jax.grad(loss, (0, 1)))(step.parameters, push)
    differences = [
        float(loss(step.parameters, push + e) - loss(step.parameters, push - e)) / (2 * h) for e in h * np.eye(3)
    ]
    assert np.abs(by_push - np.array(differences)).max() < 1e-6 * np.abs(by_push).max()
    for name in ("pilot.guidance.admittance.damping.x", "pilot.controller.position.xi.y", "plant.body.inverse_mass"):
        i = step.parameter_names.index(name)
        e = 1e-5 * step.parameters[i] * np.eye(1, len(step.parameters), i)[0]
        difference = (loss(step.parameters + e, push) - loss(step.parameters - e, push)) / (2 * e[i])
        assert by_parameters[i] == pytest.approx(float(difference), rel=2e-6), name
    smooth = [i for i in sorted(step.compiled.code.smooth["parameter"]) if np.isfinite(step.parameters[i])]
    e = np.zeros(len(step.parameters))
    e[smooth] = 1e-6 * step.parameters[smooth] * np.random.default_rng(2).standard_normal(len(smooth))
    difference = (loss(step.parameters + e, push) - loss(step.parameters - e, push)) / 2
    assert by_parameters @ e == pytest.approx(float(difference), rel=1e-4), "all of them together"


@pytest.mark.thorough
def test_tangents_batches_and_steps_of_a_call_agree(jax):
    one, ten = step_of("hover"), step_of("hover", steps=10)
    rng, jnp = np.random.default_rng(0), jax.numpy
    pushes, direction = rng.standard_normal((4, 3)), rng.standard_normal(3)

    def by_ones(push):
        return jax.lax.scan(lambda x, _: (one(x, None, push), None), one.state, None, length=10)[0]

    def by_ten(push):
        return ten(ten.state, None, push)

    assert np.array_equal(by_ten(pushes[0]), by_ones(pushes[0]))
    together = jax.jit(jax.vmap(by_ten))(pushes)
    assert np.array_equal(together, jnp.stack([by_ten(push) for push in pushes]))
    weights = rng.standard_normal(13)
    gradients = [jax.vmap(jax.grad(lambda u, by=by: weights @ by(u)[:13]))(pushes) for by in (by_ones, by_ten)]
    assert np.allclose(*gradients, rtol=1e-12, atol=1e-18)
    _, moved = jax.jvp(by_ten, (pushes[0],), (direction,))
    assert weights @ moved[:13] == pytest.approx(float(gradients[0][0] @ direction), rel=1e-10)


MANY = 16_500  # rows; jaxlib 0.10.2 gave row i the sum of row i - 64 from row 16,384 on (jax-ml/jax #39103)


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_sums_over_products_with_a_matrix_are_right_in_every_row(kind, jax):
    matrix, rows = np.eye(3, dtype=kind), np.outer(np.arange(2 * MANY), [1, 0, 0]).astype(kind)
    found = jax.jit(jax.vmap(lambda row: jax.numpy.sum((matrix @ row) ** 2)))(rows)
    assert np.allclose(found, np.arange(2.0 * MANY) ** 2, rtol=1e-6)


def test_row_by_row_many_flights_and_their_gradients_are_those_of_few(jax):
    step, weights = step_of("hover", begin=6.0), np.random.default_rng(3).standard_normal((6, 13))
    pushes = np.random.default_rng(4).standard_normal((MANY, 3))

    def loss(push):
        return jax.numpy.sum((weights @ (step(step.state, None, push)[:13] - step.state[:13])) ** 2)

    together = jax.jit(jax.vmap(jax.value_and_grad(loss)))
    some = slice(MANY - 300, MANY)
    for many, few in zip(together(pushes), together(pushes[some]), strict=True):
        assert np.allclose(many[some], few, rtol=1e-9, atol=1e-12 * np.abs(few).max())
    states = jax.jit(jax.vmap(lambda push: step(step.state, None, push)))(pushes)
    alone = [np.array(step(step.state, None, pushes[i])) for i in (0, 16_383, 16_384, MANY - 1)]
    assert np.array_equal(np.array(states)[[0, 16_383, 16_384, MANY - 1]], alone, equal_nan=True)


def test_a_channel_of_the_sample_is_a_part_of_the_state_with_a_derivative(jax):
    step, simulation, h = step_of("hover", begin=0.2, channels=("rotor_thrusts",)), tl.Simulation("hover"), 1e-6
    push = np.array([0.5, 0.0, 0.0])
    simulation.step(steps=200)
    assert np.array_equal(step.read(step.state, "rotor_thrusts"), simulation["rotor_thrusts"])
    simulation.step(push=push)
    state = step(step(step.state, None, push), None, push)
    simulation.step(push=push)
    assert np.array_equal(step.read(state, "rotor_thrusts"), simulation["rotor_thrusts"])

    def first(mass):
        parameters = jax.numpy.asarray(step.parameters).at[i].multiply(mass)
        return step.read(step(state, parameters, push), "rotor_thrusts").sum()

    i = step.parameter_names.index("pilot.controller.feedforward")
    assert jax.grad(first)(1.0) == pytest.approx(float(first(1.0 + h) - first(1.0 - h)) / (2 * h), rel=1e-6)


@pytest.mark.learning  # it compiles the longest mission, both ways
@pytest.mark.parametrize(("at", "limits_active"), [(13.433, True), (0.3, False)], ids=["limits", "floor"])
def test_the_derivatives_of_real_rotors_and_sensors_are_those_of_linearize(at, limits_active, jax):
    """Rotors at their limits, delayed sensors, and the floor below it at the start."""
    changes = QUIET | WEAK
    of = linearized("iris", changes, at, steps=1)
    assert of.made.steps[0].limits_active == limits_active
    assert of.made.steps[0].may_touch != limits_active
    step = tl.jax_step(tl.load_mission("iris", changes), begin=at)
    numbers, names = [*of.recipe.choice.kept], list(step.state_names)
    kept = numbers + [under_way(step, of, i, ago) for i, ago in of.recipe.waiting]
    eye = np.eye(len(names))[kept]
    after, moved = map(np.array, jax.jit(jax.vmap(lambda d: jax.jvp(step, (step.state,), (d,))))(eye))
    assert np.allclose(after[0][kept], of.made.x1, rtol=1e-12, atol=1e-12)
    largest = 1.0 + np.abs(of.made.A).max(axis=1, keepdims=True)
    assert (np.abs(moved[:, kept].T - of.made.A) / largest).max() < 1e-9
    _, back = jax.vjp(step, jax.numpy.asarray(step.state))
    rows = np.array(jax.jit(jax.vmap(back))(eye)[0])
    assert (np.abs(rows[:, kept] - of.made.A) / largest).max() < 1e-9


def under_way(step, of, place, ago):
    """The place in the state of a value written `ago` steps ago."""
    before = sum(one.under_way for one in of.recipe.delayed[:place])
    return step.state_names.index("under_way.0") + before + ago - 1


def test_what_cannot_be_differentiated_is_refused(jax):
    with pytest.raises(InputError, match='channels: "position" is a part of every state'):
        tl.jax_step("hover", channels=("rotor_thrusts", "position"))
    with pytest.raises(InputError, match="walls and corridor: 10 walls, must be none"):
        tl.jax_step("zigzag")
    with pytest.raises(InputError, match=r"unknown actions 'wrench'; there are push, thrusts, velocity"):
        tl.jax_step("hover", actions="wrench")
    with pytest.raises(InputError, match="steps = 0: must be a whole number of at least 1"):
        tl.jax_step("hover", steps=0)
    step = step_of("hover")
    with pytest.raises(InputError, match=r"action: an array \(2,\): must have the shape \(3,\)"):
        step(step.state, None, np.zeros(2))
    with pytest.raises(InputError, match=r'"speed": must be one of position, velocity, attitude, rates'):
        step.read(step.state, "speed")


def test_of_many_steps_those_are_let_go_that_nobody_keeps(jax):
    steps = [copy.copy(step_of("hover")) for _ in range(9)]
    first = weakref.ref(steps[0])
    while steps:
        steps[0](steps[0].state)
        steps.pop(0)
    gc.collect()
    assert first() is None


@pytest.mark.parametrize("version", ["0.10.2", "0.11.0"])
def test_a_jax_that_computes_wrong_is_refused_with_what_to_install(version, jax, monkeypatch):
    monkeypatch.setattr(jax, "__version__", version)
    with pytest.raises(InputError, match=rf"not with JAX {version}.*: pip install 'tandemlift\[jax\]' --upgrade"):
        step_of("hover")(step_of("hover").state)


def test_single_precision_is_refused(jax):
    jax.config.update("jax_enable_x64", False)
    try:
        with pytest.raises(InputError, match="jax_enable_x64"):
            step_of("hover")(step_of("hover").state)
    finally:
        jax.config.update("jax_enable_x64", True)


def test_kinks_near_a_state_are_reported_at_the_edge_of_the_dead_band():
    step = step_of("hover")
    threshold = tl.load_mission("hover").admittance.threshold[0]
    (kink,) = step.kinks(step.state, None, [threshold, 0.0, 0.0])
    assert (kink.law, kink.distance) == ("soft_threshold", 0.0)
    assert step.kinks(step.state, None, [2.0 * threshold, 0.0, 0.0]) == []
