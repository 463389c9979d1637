"""A controller in plain Python that computes as the compiled one does, to the last bit."""

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

import tandemlift as tl
from tandemlift.jit import flat, install, leaves, load, store, unflat, zeroed
from tandemlift.laws.controllers import CONTROLLERS, Measured, Reference, control, nftsmc, register


class Handed(NamedTuple):
    """What a compiled controller is handed."""

    gains: Any
    memory: Any
    measured: Any
    reference: Any


class Answered(NamedTuple):
    """What it answers."""

    command: Any
    memory: Any


class ByHand(NamedTuple):
    """Gains of a controller that Python calls, which calls the paper's law compiled by itself."""

    gains: Any


@pytest.fixture
def by_hand():
    """Changes to `iris` by which its controller is a function that the loop does not know how to compile."""
    install()
    laws: dict[str, Any] = {}

    def compiled(like, answer):
        @numba.njit(error_model="numpy")
        def law(a, y):
            x = load(a, like)
            store(y, control(x.gains, x.memory, x.measured, x.reference))

        return law, np.zeros(leaves(answer))

    @control.register(ByHand, compiled=False)
    def call(k: ByHand, memory: Any, measured: Measured, reference: Reference) -> Any:
        handed = Handed(k.gains, memory, measured, reference)
        answer = Answered(*control(*handed))
        if "law" not in laws:
            laws["law"], laws["y"] = compiled(zeroed(handed), answer)
        laws["law"](np.array(flat(handed)), laws["y"])
        return unflat(laws["y"], answer)

    class Settings(nftsmc.NFTSMCSettings):
        name: str = "by-hand"

    @register("by-hand", Settings)
    def start(settings, vehicle, step):
        """The paper's controller, called from Python."""
        gains, memory = nftsmc.start(settings, vehicle, step)
        return ByHand(gains), memory

    yield {"controller": {**tl.load_mission("iris").controller.model_dump(mode="json"), "name": "by-hand"}}
    CONTROLLERS.pop("by-hand")
    control.table.pop(ByHand)
    control.interpreted.discard(ByHand)
