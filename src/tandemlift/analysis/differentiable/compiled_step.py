"""An `IteratedStep` as machine code, called from NumPy: states, tangents and cotangents of many lanes."""

from __future__ import annotations

import ctypes
import math
import os
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.analysis.differentiable.iterated import ARGUMENTS, OF_STEPS, IteratedStep, Kind
from tandemlift.compiler.machine_code import machine, store
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array

WORTH = 2e-4  # s of machine code in a call, from which on threads share it
CALL = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)
NUMBER = 8  # bytes
LOADED: dict[str, machine.Loaded] = {}  # functions by their keys; others, such as XLA, keep their addresses


class CompiledStep:
    """An `IteratedStep` over arrays of NumPy: states, tangents and cotangents, lane by lane.

    Arrays may have leading dimensions, which are broadcast: a lane of a call has its own numbers or shares them with
    others, without a copy. Those of actions and states have one for the steps before the last: (…, steps, n). Actions,
    and their tangents, that are held during the call have the size 1 there.

    A function is compiled on first use, or read from disk.

    Args:
        code: the step.
        threads: that share the lanes of a call if it takes long enough; by default one for each processor.
    """

    def __init__(self, code: IteratedStep, threads: int | None = None) -> None:
        self.code, self.threads = code, threads or os.cpu_count() or 1
        self._functions = dict[tuple[Kind, bool], tuple[str, Any]]()
        self._pace = dict[tuple[Kind, bool], float]()  # s for a step of a lane

    def advance(self, state: Any, parameters: Any, actions: Any, steps: int) -> Array:
        """The states after each step (…, steps, n).

        Args:
            state: at the start (…, n).
            parameters: of all steps (…, m).
            actions: of each step, or held (…, steps or 1, actions).
            steps: their number.

        Raises:
            InputError: an array has another shape.
        """
        (states,) = self._called("advance", True, steps, [state, parameters, actions])
        return states

    def tangent(
        self, state: Any, parameters: Any, actions: Any, states: Any, dstate: Any, dparameters: Any, dactions: Any
    ) -> Array:
        """The tangents of the states after each step (…, steps, n), from those of the arguments.

        Args:
            state: as for `advance`, like the next two.
            parameters: of all steps.
            actions: of each step, or held.
            states: that `advance` gave.
            dstate: tangent of `state`.
            dparameters: tangent of `parameters`; None for 0, which costs about half.
            dactions: tangent of `actions`, each or held.
        """
        by_parameters = dparameters is not None
        given = [state, parameters, actions, states, dstate, dparameters if by_parameters else np.zeros(0), dactions]
        (moved,) = self._called("tangent", by_parameters, np.shape(states)[-2], given)
        return moved

    def cotangent(
        self, state: Any, parameters: Any, actions: Any, states: Any, bars: Any, by_parameters: bool = True
    ) -> tuple[Array, Array, Array]:
        """The cotangents of state, parameters and actions of each lane, from those of the states after each step.

        Args:
            state: as for `advance`, like the next two.
            parameters: of all steps.
            actions: of each step, or held: their cotangent has the same number of steps.
            states: that `advance` gave.
            bars: cotangents of `states`.
            by_parameters: whether those of parameters are formed, which costs as much again; else they are empty.
        """
        given = [state, parameters, actions, states, bars]
        own, of_parameters, of_actions = self._called("cotangent", by_parameters, np.shape(states)[-2], given)
        return own, of_parameters, of_actions

    def function(self, kind: Kind, by_parameters: bool) -> tuple[str, Any]:
        """The key of a function's machine code, and the function; see `analysis.differentiable.iterated`."""
        by_parameters = by_parameters or kind == "advance"  # which has no derivatives
        if (kind, by_parameters) not in self._functions:
            text = self.code.written(kind, by_parameters)
            key = store.key_of_module(text, {})
            if key not in LOADED:
                LOADED[key] = machine.Loaded(_machine_code(text, key), [kind])
            self._functions[kind, by_parameters] = key, CALL(LOADED[key].addresses[kind])
        return self._functions[kind, by_parameters]

    def _called(self, kind: Kind, by_parameters: bool, steps: int, given: Sequence[Any]) -> list[Array]:
        """The results of a call."""
        sizes, (arguments, results) = self.code.sizes_of(by_parameters), ARGUMENTS[kind]
        arrays = [_checked(x, of, steps, sizes[of]) for x, of in zip(given, arguments, strict=True)]
        leading = [x.shape[: -2 if of in OF_STEPS else -1] for x, of in zip(arrays, arguments, strict=True)]
        lanes = leading[0] if all(one == leading[0] for one in leading) else np.broadcast_shapes(*leading)
        held = arrays[2].shape[-2]  # 1 or `steps`: results for actions have as many
        for of in results:
            shape = (held if of == "action" else steps,) if of in OF_STEPS else ()
            arrays.append(np.empty((*lanes, *shape, sizes[of])))
        count, words, own = math.prod(lanes), list[int](), list[Array]()  # the arrays live until the call is over
        for array, of in zip(arrays, (*arguments, *results), strict=True):
            own.append(_in_lanes(array, lanes, count, 2 if of in OF_STEPS else 1))
            words += _words(own[-1], of in OF_STEPS)
        self._run(kind, by_parameters, (ctypes.c_int64 * len(words))(*words), count, steps)
        return arrays[len(arguments) :]

    def _run(self, kind: Kind, by_parameters: bool, words: Any, count: int, steps: int) -> None:
        """Call a function; threads share the lanes if that pays."""
        (_, call), pace = self.function(kind, by_parameters), self._pace.get((kind, by_parameters), 0.0)
        parts, began = max(1, min(self.threads, count, int(pace * count * steps / WORTH))), time.perf_counter()
        if parts == 1:
            call(words, 0, count, steps)
        else:
            cuts = [count * i // parts for i in range(parts + 1)]
            list(self._pool.map(call, [words] * parts, cuts[:-1], cuts[1:], [steps] * parts))
        if count:
            self._pace[kind, by_parameters] = (time.perf_counter() - began) * parts / (count * steps)

    @cached_property
    def _pool(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(self.threads, thread_name_prefix="lanes")


def _machine_code(text: str, key: str) -> bytes:
    """The machine code of a module, from disk or compiled."""

    def made() -> store.StoredCode:
        return store.StoredCode({}, machine.optimised(text))

    return store.kept(f"{key}-best", made).code


def _checked(given: Any, of: str, steps: int, size: int) -> Array:
    """An array with as many dimensions as it needs.

    Raises:
        InputError: its last ones have other sizes.
    """
    array = np.asarray(given, dtype=float)
    wanted = (steps, size) if of in OF_STEPS else (size,)
    shape = array.shape[-len(wanted) :]
    if shape != wanted and not (of == "action" and shape == (1, size)):
        raise InputError(f"{of}: an array {array.shape}: its last dimensions must be {wanted}")
    return array


def _in_lanes(array: Array, lanes: tuple[int, ...], count: int, tail: int) -> Array:
    """An array with one dimension of lanes before its last `tail` ones; a copy if it lies otherwise in memory."""
    own = array.shape[array.ndim - tail :]
    if array.shape[:-tail] != lanes:
        array = np.broadcast_to(array, (*lanes, *own))
    if len(lanes) != 1:
        array = array.reshape(count, *own)
    flags, by = array.flags, array.strides
    in_order = flags.c_contiguous or (by[-1] == NUMBER and min(by) >= 0 and not any(x % NUMBER for x in by))
    return array if in_order and flags.aligned else np.array(array)


def _words(array: Array, of_steps: bool) -> tuple[int, int, int]:
    """Address, numbers from lane to lane, and from step to step: 0 for an action that is held."""
    lane, *others = array.strides
    step = others[0] // NUMBER if of_steps and array.shape[1] > 1 else 0
    return array.ctypes.data, lane // NUMBER, step
