"""A step of a flight as a function of arrays; what its forms for JAX and PyTorch have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift.analysis.differentiable.compiled_step import CompiledStep
from tandemlift.analysis.differentiable.iterated import IteratedStep
from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array


class FlightStep(ABC):
    """A step of a flight as a function: next = step(state, parameters, action).

    The state is all that a flight carries from step to step, with the values in delay lines and the number of the step.
    Parameters are the numbers of vehicle, pilot, sensors and pushes, as assembled from the mission.

    Attributes:
        state: numbers at the start (n,).
        parameters: of the mission (m,).
        state_names: of the state's numbers, dotted.
        parameter_names: of the parameters, dotted.
        places: of parts of the state, by their names.
        actions: number of actions.
        steps: of a call.
        compiled: the step over arrays of NumPy.
    """

    def __init__(
        self,
        code: IteratedStep,
        start: tuple[Array, Array],
        names: tuple[Sequence[str], Sequence[str]],
        places: Mapping[str, slice],
        steps: int,
        kinks: Callable[[Array, Array, Array, float], list[Any]],
    ) -> None:
        self.compiled, self._kinks = CompiledStep(code), kinks
        self.state, self.parameters = start
        self.state_names, self.parameter_names = map(tuple, names)
        self.places, self.steps, self.actions = dict(places), steps, code.sizes["action"]

    def __call__(self, state: Any, parameters: Any = None, action: Any = None) -> Any:
        """The state after a call's steps, during which the action is held.

        Args:
            state: at the start (n,).
            parameters: of the mission (m,); by default `parameters`.
            action: (actions,); by default 0.

        Raises:
            InputError: an argument has another shape, precision or device.
        """
        return self.all(state, parameters, action)[..., -1, :]

    @abstractmethod
    def all(self, state: Any, parameters: Any = None, action: Any = None) -> Any:
        """The states after each step of a call (steps, n); arguments as for a call."""

    def read(self, state: Any, name: str) -> Any:
        """A part of the state: "position", "velocity", "attitude", "rates", or one of the chosen channels.

        Raises:
            InputError: the state has no such part.
        """
        if name not in self.places:
            raise InputError(f"{shown(name)}: must be one of {', '.join(self.places)}; others by channels=(…)")
        return state[..., self.places[name]]

    def kinks(self, state: Any, parameters: Any = None, action: Any = None, tolerance: float = 1e-4) -> list[Any]:
        """The kinks near a state, as `linearize` reports them: there the derivative holds on one side only.

        Args:
            state: at the start of a step (n,).
            parameters: of the mission (m,); by default `parameters`.
            action: (actions,); by default 0.
            tolerance: the largest distance of a kink, in the unit of a state or input.
        """
        state, parameters, action = map(np.asarray, self.with_defaults(state, parameters, action))
        return self._kinks(state, parameters, action, tolerance)

    def with_defaults(self, state: Any, parameters: Any, action: Any) -> tuple[Any, Any, Any]:
        """The arguments of a call."""
        given = self.parameters if parameters is None else parameters
        return state, given, np.zeros(self.actions) if action is None else action
