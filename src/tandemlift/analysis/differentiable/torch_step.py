"""A `FlightStep` of PyTorch: operators with derivatives, reverse and forward, on the processor.

The functions of a `CompiledStep` are operators `torch.ops.tandemlift`, which `torch.compile` knows; their last argument
is the number of the step in `STEPS`. An operator cannot be differentiated by `torch.func`: unless something is being
compiled, functions of autograd are called in their place, which costs less, too.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any, NoReturn, cast

from tandemlift.analysis.differentiable.compiled_step import CompiledStep
from tandemlift.analysis.differentiable.flight_step import FlightStep
from tandemlift.analysis.differentiable.iterated import INPUTS, Kind
from tandemlift.core.errors import InputError, extra

STEPS: list[CompiledStep] = []
LIBRARY: list[Any] = []  # of operators, which exist as long as it
INPUT = "Tensor state, Tensor parameters, Tensor actions"  # leading dimensions, the lanes, are equal in all tensors
SCHEMAS: dict[Kind, str] = {
    "advance": f"({INPUT}, int steps, int step) -> Tensor",
    "tangent": f"({INPUT}, Tensor states, Tensor dstate, Tensor? dparameters, Tensor dactions, int step) -> Tensor",
    "cotangent": f"({INPUT}, Tensor states, Tensor bars, bool by_parameters, int step) -> (Tensor, Tensor, Tensor)",
}
Calls = Mapping[Kind, Callable[..., Any]]


class TorchStep(FlightStep):
    """A step of a flight as a function of PyTorch; see `tandemlift.torch_step`."""

    def __init__(self, *parts: Any) -> None:
        with extra("torch", "torch_step"):
            import torch
        super().__init__(*parts)
        self._calls, self._number = _defined(), len(STEPS)
        self._defaults = [torch.from_numpy(x) for x in self.with_defaults(self.state, None, None)]
        STEPS.append(self.compiled)

    def all(self, state: Any, parameters: Any = None, action: Any = None) -> Any:
        """The states after each step of a call (…, steps, n); arguments as for a call, with any leading dimensions."""
        import torch

        given = zip(INPUTS, (state, parameters, action), self._defaults, strict=True)
        tensors = [default if x is None else _checked(name, x, len(default)) for name, x, default in given]
        lanes = [x.shape[:-1] for x in tensors]
        if any(lanes):
            shape = torch.broadcast_shapes(*lanes)
            tensors = [x.expand(*shape, x.shape[-1]) for x in tensors]
        state, parameters, action = tensors
        call = self._calls[torch.compiler.is_compiling()]
        return call(state, parameters, action.unsqueeze(-2), self.steps, self._number)

    def kinks(self, state: Any, parameters: Any = None, action: Any = None, tolerance: float = 1e-4) -> list[Any]:
        """As of `FlightStep`."""
        state, parameters, action = (x.detach() if hasattr(x, "detach") else x for x in (state, parameters, action))
        return super().kinks(state, parameters, action, tolerance)


def _checked(name: str, given: Any, size: int) -> Any:
    """A tensor of that last size.

    Raises:
        InputError: it has another size or precision, or is on another device.
    """
    import torch

    tensor = given if isinstance(given, torch.Tensor) else torch.as_tensor(given, dtype=torch.float64)
    if tensor.device.type != "cpu":
        raise InputError(f"{name}: a tensor on {tensor.device}: must be on the processor, as of .cpu()")
    if tensor.dtype != torch.float64:
        raise InputError(f"{name}: a tensor of {tensor.dtype}: must be of torch.float64, as of .double()")
    if tensor.shape[-1:] != (size,):
        raise InputError(f"{name}: a tensor {tuple(tensor.shape)}: its last dimension must be {size}")
    return tensor


# ---- The functions over tensors


@functools.cache
def _defined() -> tuple[Callable[..., Any], Callable[..., Any]]:
    """`advance` of PyTorch, as it is called and as it is compiled."""
    import torch

    LIBRARY.append(library := torch.library.Library("tandemlift", "FRAGMENT"))
    operators = {kind: _operator(library, kind) for kind in SCHEMAS}

    def below(kind: Kind) -> Callable[..., Any]:
        def call(*given: Any) -> Any:
            with torch._C._AutoDispatchBelowAutograd():
                return operators[kind](*given)

        return call

    direct: dict[Kind, Callable[..., Any]] = {}
    for kind in SCHEMAS:
        library.impl(kind, _differentiable(kind, below(kind), operators), "Autograd")
        direct[kind] = _differentiable(kind, _over_arrays(kind) if kind == "advance" else below(kind), direct)
    return direct["advance"], operators["advance"]


def _operator(library: Any, kind: Kind) -> Any:
    """An operator without derivatives."""
    import torch

    library.define(kind + SCHEMAS[kind])
    operator, name = getattr(torch.ops.tandemlift, kind), f"tandemlift::{kind}"
    library.impl(kind, _over_arrays(kind), "CPU")
    torch.library.register_fake(name, functools.partial(_shapes, kind), lib=library)
    torch.library.register_vmap(name, _batched(operator), lib=library)
    return operator


def _shapes(kind: Kind, state: Any, parameters: Any, actions: Any, *others: Any) -> Any:
    """Results without numbers."""
    if kind == "tangent":
        return others[0].new_empty(others[0].shape)
    if kind == "advance":
        return state.new_empty((*state.shape[:-1], others[0], state.shape[-1]))
    number = parameters.shape[-1] if others[2] else 0
    return tuple(state.new_empty(shape) for shape in (state.shape, (*parameters.shape[:-1], number), actions.shape))


def _over_arrays(kind: Kind) -> Callable[..., Any]:
    """A function of a `CompiledStep` over the memory of tensors."""
    import torch

    def call(*given: Any) -> Any:
        *arguments, step = [x.numpy(force=True) if isinstance(x, torch.Tensor) else x for x in given]
        found = getattr(STEPS[step], kind)(*arguments)
        return tuple(map(torch.from_numpy, found)) if isinstance(found, tuple) else torch.from_numpy(found)

    call.__signature__ = inspect.signature(call)  # type: ignore[attr-defined]  # autograd asks for it in each call
    return call


def _batched(call: Callable[..., Any]) -> Callable[..., Any]:
    """The rule of `vmap` for a function: its dimension becomes the first one of the lanes."""

    def rule(info: Any, dimensions: Any, *given: Any) -> tuple[Any, Any]:
        import torch

        moved = list[Any]()
        for x, d in zip(given, dimensions, strict=True):
            lanes = isinstance(x, torch.Tensor)
            moved.append(x if not lanes else x.expand(info.batch_size, *x.shape) if d is None else x.movedim(d, 0))
        found = call(*moved)
        return found, (0,) * len(found) if isinstance(found, tuple) else 0

    return rule


def _differentiable(kind: Kind, forward: Callable[..., Any], calls: Calls) -> Callable[..., Any]:
    """A function of autograd, whose derivatives call others; those have none themselves."""
    import torch

    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        if kind == "advance":
            ctx.save_for_backward(*inputs[:3], output)
            ctx.save_for_forward(*inputs[:3], output)
            ctx.step = inputs[-1]
            ctx.set_materialize_grads(False)

    def backward(ctx: Any, bars: Any) -> tuple[Any, ...]:
        if bars is None:
            return (None,) * 5
        by_parameters = ctx.needs_input_grad[1]
        by_state, found, by_actions = calls["cotangent"](*ctx.saved_tensors, bars, by_parameters, ctx.step)
        return by_state, found if by_parameters else None, by_actions, None, None

    def jvp(ctx: Any, dstate: Any, dparameters: Any, dactions: Any, *_: Any) -> Any:
        state, _, actions, _ = ctx.saved_tensors
        dstate = state.new_zeros(state.shape) if dstate is None else dstate
        dactions = actions.new_zeros(actions.shape) if dactions is None else dactions
        return calls["tangent"](*ctx.saved_tensors, dstate, dparameters, dactions, ctx.step)

    def refused(*_: Any) -> NoReturn:
        raise InputError("a step of a flight has first derivatives only")

    rules: dict[str, Callable[..., Any]] = {"forward": forward, "setup_context": setup_context}
    rules |= {"backward": backward, "jvp": jvp} if kind == "advance" else {"backward": refused, "jvp": refused}
    function: Any = type(kind, (torch.autograd.Function,), {name: staticmethod(rule) for name, rule in rules.items()})
    function.vmap = staticmethod(_batched(function.apply))
    return cast(Callable[..., Any], function.apply)
