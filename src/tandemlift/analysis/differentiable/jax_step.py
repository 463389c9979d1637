"""An `IteratedStep` as a function of JAX: with `jit`, `vmap`, `scan`, `jvp` and `grad`, on the processor."""

from __future__ import annotations

import ctypes
import functools
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, get_args

from tandemlift.analysis.differentiable.flight_step import FlightStep
from tandemlift.analysis.differentiable.iterated import ARGUMENTS, INPUTS, WORDS, Kind
from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.tracer import Function, Graph, Module
from tandemlift.core.errors import InputError, extra, install_command

LOADED: dict[str, machine.Loaded] = {}  # handlers that XLA knows, by their names
EXTENSION, ARGUMENTS_AT, RESULTS_AT = 1, 9, 14  # words to these in XLA's frame (`xla/ffi/api/c_api.h`)
DATA, RANK, DIMENSIONS = 3, 4, 5  # words to these in a buffer
FAULTY = ("0.10.2", "0.11.0")  # wrong sums on the processor (jax-ml/jax #39103); crashes of the same code (#39257)


class JaxStep(FlightStep):
    """A step of a flight as a function of JAX; see `tandemlift.jax_step`."""

    def all(self, state: Any, parameters: Any = None, action: Any = None) -> Any:
        """The states after each step of a call (steps, n); arguments as for a call."""
        jax = _jax()
        if not jax.config.jax_enable_x64:
            raise InputError('JAX computes in single precision: first jax.config.update("jax_enable_x64", True)')
        arrays = [jax.numpy.asarray(x, dtype=float) for x in self.with_defaults(state, parameters, action)]
        for name, array in zip(INPUTS, arrays, strict=True):
            wanted = (self.compiled.code.sizes[name],)
            if array.shape != wanted:
                raise InputError(f"{name}: an array {array.shape}: must have the shape {wanted}")
        (states,) = _primitives()["advance"].bind(*arrays, step=self, with_parameters=True)
        return states.reshape(self.steps, -1)

    def layout(self, kind: Kind, with_parameters: bool) -> list[tuple[int, int]]:
        """How many numbers each argument and result has, and how many from step to step.

        Derivatives take the states between the steps of a call: all but the last.
        """
        sizes, (arguments, results) = self.compiled.code.sizes_of(with_parameters), ARGUMENTS[kind]
        found = [(sizes[of], 0) for of in (*arguments, *results)]
        for place, of in enumerate((*arguments, *results)):
            if of == "states":
                between = place == 3 and kind != "advance"
                found[place] = (self.steps - between) * sizes[of], sizes[of]
        return found

    def handler(self, kind: Kind, with_parameters: bool) -> str:
        """The name by which XLA calls the function of a kind, which is compiled on first use."""
        key, call = self.compiled.function(kind, with_parameters)
        name = f"tandemlift_{kind}_{self.steps}_{key}"
        if name not in LOADED:
            address = ctypes.cast(call, ctypes.c_void_p).value
            text = _handler(address, self.layout(kind, with_parameters), len(ARGUMENTS[kind][0]), self.steps)
            LOADED[name] = machine.Loaded(machine.compiled(text, machine.QUICK), ["handler"])
            ffi = _jax().ffi
            ffi.register_ffi_target(name, ffi.pycapsule(LOADED[name].addresses["handler"]), platform="cpu")
        return name


def _handler(address: int | None, layout: Sequence[tuple[int, int]], arguments: int, steps: int) -> str:
    """The text of a handler, which XLA calls with a frame: it tells its version, or calls the function at an address.

    The number of lanes is the product of the first array's leading dimensions.
    """
    major, minor = _version()
    f = Function(Module(), Graph(), 1, "i64 @handler(ptr %frame) #0")
    extension = f.load("%frame", EXTENSION, "ptr")
    asked = f.op(f"icmp ne ptr {extension}, null")
    with f.when(asked):
        facts = f.load(extension, 3, "ptr")
        f.store(str(major + (minor << 32)), facts, 3, "i64")  # two numbers of 32 bits
        f.store("0", facts, 8, "i32")  # no traits
    with f.when(f.op(f"xor i1 {asked}, true")):
        words, count = f.own_memory(WORDS * len(layout)), f.own_memory(1)
        given, made = (f.load("%frame", at, "ptr") for at in (ARGUMENTS_AT, RESULTS_AT))
        buffers = [f.load(given, i, "ptr") for i in range(arguments)]
        buffers += [f.load(made, i, "ptr") for i in range(len(layout) - arguments)]
        for i, (buffer, (lane, step)) in enumerate(zip(buffers, layout, strict=True)):
            f.store(f.load(buffer, DATA, "ptr"), words, WORDS * i, "ptr")
            f.store(str(lane), words, WORDS * i + 1, "i64")
            f.store(str(step), words, WORDS * i + 2, "i64")
        f.store("1", count, 0, "i64")
        dimensions = f.load(buffers[0], DIMENSIONS, "ptr")
        with f.repeat(f.integer("sub", f.load(buffers[0], RANK, "i64"), 1)) as place:
            f.store(f.integer("mul", f.load(count, 0, "i64"), f.load(dimensions, place, "i64")), count, 0, "i64")
        lanes = f.load(count, 0, "i64")
        f.do(f"call i64 inttoptr (i64 {address} to ptr)(ptr {words}, i64 0, i64 {lanes}, i64 {steps})")
    f.end("i64 0")
    return f.module.text


def _jax() -> Any:
    """JAX.

    Raises:
        InputError: it is not installed, or of a version that computes wrong.
    """
    with extra("jax", "jax_step"):
        import jax
    if jax.__version__ in FAULTY:
        raise InputError(
            f"jax_step works, but not with JAX {jax.__version__}, which computes wrong sums on the processor or "
            f"crashes: {install_command('jax')} --upgrade"
        )
    return jax


@functools.cache
def _version() -> tuple[int, int]:
    """The version of XLA's interface for handlers."""
    header = (Path(_jax().ffi.include_dir()) / "xla/ffi/api/c_api.h").read_text()
    major, minor = (int(re.findall(rf"#define XLA_FFI_API_{part} (\d+)", header)[0]) for part in ("MAJOR", "MINOR"))
    return major, minor


@functools.cache
def _primitives() -> dict[Kind, Any]:
    """The three functions as primitives of JAX; their arrays may have leading dimensions, equal in all."""
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir

    jax = _jax()
    made: dict[Kind, Any] = {kind: Primitive(f"tandemlift_{kind}") for kind in get_args(Kind)}

    def define(kind: Kind, primitive: Any) -> None:
        primitive.multiple_results = True

        @functools.lru_cache(8)  # keeps its steps
        def jitted(step: JaxStep, with_parameters: bool) -> Any:
            return jax.jit(functools.partial(primitive.bind, step=step, with_parameters=with_parameters))

        @primitive.def_abstract_eval
        def shapes(*arrays: Any, step: JaxStep, with_parameters: bool) -> list[Any]:
            results = step.layout(kind, with_parameters)[len(arrays) :]
            return [jax.core.ShapedArray((*arrays[0].shape[:-1], size), arrays[0].dtype) for size, _ in results]

        def lower(context: Any, *arrays: Any, step: JaxStep, with_parameters: bool) -> Any:
            return jax.ffi.ffi_lowering(step.handler(kind, with_parameters))(context, *arrays)

        def batch(arrays: Sequence[Any], axes: Sequence[int | None], **settings: Any) -> Any:
            count = next(x.shape[axis] for x, axis in zip(arrays, axes, strict=True) if axis is not None)
            first = [_in_front(x, axis, count) for x, axis in zip(arrays, axes, strict=True)]
            return primitive.bind(*first, **settings), (0,) * len(ARGUMENTS[kind][1])

        primitive.def_impl(lambda *arrays, **settings: jitted(**settings)(*arrays))
        mlir.register_lowering(primitive, lower, platform="cpu")
        batching.primitive_batchers[primitive] = batch

    def _in_front(x: Any, axis: int | None, count: int) -> Any:
        return jax.numpy.broadcast_to(x, (count, *x.shape)) if axis is None else jax.numpy.moveaxis(x, axis, 0)

    def advance_with_tangent(arrays: Sequence[Any], moved: Sequence[Any], *, step: JaxStep, **_: Any) -> Any:
        (states,) = made["advance"].bind(*arrays, step=step, with_parameters=True)
        with_parameters = type(moved[1]) is not ad.Zero
        given = [ad.instantiate_zeros(x) for x in moved]
        given[1] = given[1] if with_parameters else given[1][..., :0]
        between = states[..., : (step.steps - 1) * len(step.state)]
        return [states], made["tangent"].bind(*arrays, between, *given, step=step, with_parameters=with_parameters)

    def transposed(bars: Sequence[Any], *arrays: Any, step: JaxStep, with_parameters: bool) -> list[Any]:
        (bar,) = map(ad.instantiate_zeros, bars)
        found = made["cotangent"].bind(*arrays[:4], bar, step=step, with_parameters=with_parameters)
        return [None] * 4 + [
            one if ad.is_undefined_primal(x) else None for one, x in zip(found, arrays[4:], strict=True)
        ]

    for kind, primitive in made.items():
        define(kind, primitive)
    ad.primitive_jvps[made["advance"]] = advance_with_tangent
    ad.primitive_transposes[made["tangent"]] = transposed
    return made
