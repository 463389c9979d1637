"""`tl.torch_step`: the bits of a simulation, the gradients of JAX, PyTorch's checks; the example of its page."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
import torch
from repository import ROOT

import tandemlift as tl
from tandemlift.core.errors import InputError

pytestmark = [
    pytest.mark.learning,
    # PyTorch's own uses; the first is a DeprecationWarning in 2.6, a FutureWarning in 2.14
    pytest.mark.filterwarnings("ignore:`torch.jit.script` is deprecated"),
    pytest.mark.filterwarnings("ignore:The .grad attribute of a Tensor that is not a leaf"),
]

PUSHES = torch.from_numpy(np.random.default_rng(3).uniform(-2.0, 2.0, (4, 3)))
WEIGHTS = torch.arange(1.0, 14.0, dtype=torch.float64)


@cache
def step_of(name="hover", steps=1, begin=6.0, channels=()):
    return tl.torch_step(name, steps=steps, begin=begin, channels=channels)


def motion(push):
    """Thirteen numbers of the motion after three steps, each scaled otherwise."""
    step = step_of(steps=3)
    return step(torch.from_numpy(step.state), None, push)[..., :13] * WEIGHTS


@pytest.mark.parametrize("name", ["paper", "one-push"])
def test_a_step_has_the_bits_of_a_simulation_in_each_lane(name):
    step = step_of(name, begin=0.0)
    size, state = step.state_names.index("step"), torch.from_numpy(step.state)
    simulations = [tl.Simulation(name) for _ in PUSHES]
    for _ in range(20):
        state = step(state, None, PUSHES)
        for simulation, push in zip(simulations, PUSHES, strict=True):
            simulation.step(push=push.numpy())
    for own, simulation in zip(state, simulations, strict=True):
        assert np.array_equal(own[:size].numpy(), simulation._stepper.a[:size], equal_nan=True)


def test_gradients_by_state_parameters_and_action_are_those_of_jax(jax):
    step, same = step_of("paper"), tl.jax_step("paper", begin=6.0)
    start = same.state, same.parameters, PUSHES[0].numpy()

    def loss(state, parameters, push):
        end, _ = jax.lax.scan(lambda x, _: (same(x, parameters, push), None), state, None, length=50)
        return end[:13] @ WEIGHTS.numpy()

    wanted = jax.jit(jax.grad(loss, (0, 1, 2)))(*start)
    given = [torch.from_numpy(x).clone().requires_grad_() for x in start]
    state = given[0]
    for _ in range(50):
        state = step(state, given[1], given[2])
    found = torch.autograd.grad(state[:13] @ WEIGHTS, given)
    for own, reference in zip(found, wanted, strict=True):
        assert np.abs(own.numpy() - reference).max() < 1e-12 * np.abs(reference).max()


def test_gradients_pass_the_checks_of_pytorch():
    push = PUSHES.clone().requires_grad_()
    ways = {"check_forward_ad": True, "check_batched_grad": True, "check_batched_forward_grad": True}
    assert torch.autograd.gradcheck(motion, (push,), eps=1e-5, atol=1e-9, rtol=1e-4, **ways)


def test_the_operators_pass_the_checks_of_pytorch():
    step, operators = step_of(steps=3), torch.ops.tandemlift
    state, parameters = (torch.from_numpy(x).expand(4, -1) for x in (step.state, step.parameters))
    push, number = PUSHES.unsqueeze(-2), step._number
    inputs = state.clone().requires_grad_(), parameters, push.clone().requires_grad_()
    torch.library.opcheck(operators.advance.default, (*inputs, 3, number))
    states = step.all(state, parameters, PUSHES)
    for dparameters in (None, torch.zeros_like(parameters)):
        given = state, parameters, push, states, torch.ones_like(state), dparameters, push, number
        torch.library.opcheck(operators.tangent.default, given)
    for by_parameters in (False, True):
        given = state, parameters, push, states, torch.ones_like(states), by_parameters, number
        torch.library.opcheck(operators.cotangent.default, given)


def test_transforms_of_torch_func_agree():
    func, together = torch.func, motion(PUSHES)
    assert torch.equal(func.vmap(motion)(PUSHES), together)
    assert torch.equal(torch.stack([motion(push) for push in PUSHES]), together)
    forward, reverse = (func.vmap(way(motion))(PUSHES) for way in (func.jacfwd, func.jacrev))
    assert torch.allclose(forward, reverse, rtol=1e-12, atol=1e-15)
    vectorized = torch.autograd.functional.jacobian(motion, PUSHES[0], vectorize=True)
    assert torch.allclose(vectorized, reverse[0], rtol=1e-12, atol=1e-15)
    push = PUSHES.clone().requires_grad_()
    (plain,) = torch.autograd.grad(motion(push).sum(), push)
    assert torch.allclose(func.vmap(func.grad(lambda u: motion(u).sum()))(PUSHES), plain, rtol=1e-12, atol=1e-15)


def test_a_gradient_by_parameters_that_lanes_share_is_the_sum_over_lanes():
    step = step_of()
    state, parameters = torch.from_numpy(step.state), torch.from_numpy(step.parameters).clone().requires_grad_()
    (shared,) = torch.autograd.grad(step(state, parameters, PUSHES)[:, :13].sum(), parameters)
    own = [torch.autograd.grad(step(state, parameters, push)[:13].sum(), parameters)[0] for push in PUSHES]
    assert shared.abs().max() > 0.0
    assert torch.allclose(shared, sum(own), rtol=1e-12, atol=1e-18)


def test_compiled_whole_it_has_the_same_gradient():
    push, step = PUSHES.clone().requires_grad_(), step_of(steps=3)
    whole = torch.compile(lambda u: step(step.state, None, u)[..., :13] * WEIGHTS, backend="aot_eager", fullgraph=True)
    plain, compiled = (torch.autograd.grad(f(push).sum(), push)[0] for f in (motion, whole))
    assert torch.equal(plain, compiled)


@pytest.mark.parametrize("twice", [torch.func.hessian, lambda f: torch.func.jacrev(torch.func.jacfwd(f))])
def test_second_derivatives_are_refused(twice):
    with pytest.raises(InputError, match="first derivatives only"):
        twice(lambda push: motion(push).sum())(PUSHES[0])


def test_what_it_cannot_take_is_refused():
    step = step_of()
    state = torch.from_numpy(step.state)
    with pytest.raises(InputError, match=r"state: a tensor of torch\.float32: must be of torch\.float64"):
        step(state.float())
    with pytest.raises(InputError, match=r"state: a tensor on meta: must be on the processor, as of \.cpu\(\)"):
        step(state.to("meta"))
    with pytest.raises(InputError, match=r"action: a tensor \(4, 2\): its last dimension must be 3"):
        step(state, None, PUSHES[:, :2])
    with pytest.raises(InputError, match="walls and corridor: 10 walls, must be none"):
        tl.torch_step("zigzag")


def test_the_example_of_its_page_prints_what_it_says(capsys):
    page = (ROOT / "docs" / "how-to" / "gradients.md").read_text("utf-8")
    ((code, printed),) = re.findall(r"^```python\n(import torch.*?)^```\n\n```text\n(.*?)^```", page, flags=re.M | re.S)
    exec(compile(code, "gradients.md", "exec"), {})
    assert capsys.readouterr().out == printed
